// SPDX-License-Identifier: Apache-2.0
// Evaluates a pattern on every face of a range: an instance of it each, one invocation per vertex.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/displacement.h"

layout(constant_id = 0) const uint kPatchDisplacement = kNoDisplacement;
layout(constant_id = 1) const uint kPatchCorners = 0u;
layout(constant_id = 2) const bool kAdaptive = false;
#include "aglow/refine/gpu/patch_surface.glsl"

layout(local_size_x = kPatchGroup) in;
layout(push_constant, scalar) uniform Push { PatchEvaluateArgs args; };

void main() {
    uint index = global_index();
    uint instance = index / args.vertex_count;
    if (instance >= args.face_count) return;
    uint face = args.first_face + instance;
    PatchLevels levels = uniform_levels();
    if (kAdaptive) levels = args.levels.at[face];
    SurfaceVertex vertex =
        patch_vertex(args.mesh.at[0], face, args.steps.at[index - instance * args.vertex_count],
                     args.segments, levels);
    args.positions.at[index] = vertex.position;
    args.normals.at[index] = vertex.normal;
}
