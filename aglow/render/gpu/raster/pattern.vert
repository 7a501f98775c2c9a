// SPDX-License-Identifier: Apache-2.0
// Vertices of a pattern that is drawn as one instance for each face, on a curved patch over it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/raster.glsl"
#include "aglow/shared/raster_pattern.h"

const uint kPatchDisplacement = kNoDisplacement;
const uint kPatchCorners = 3u;
#include "aglow/refine/gpu/patch_surface.glsl"

invariant gl_Position;  // faces of several materials meet
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 barycentrics;  // on the face
layout(location = 3) flat out uint face;

void main() {
    RasterPattern pattern = RasterPatternPtr(args.geometry).at[0];
    face = face_at(uint(gl_InstanceIndex));
    position = normal = vec3(0.0f);
    barycentrics = vec2(0.0f);
    gl_Position = vec4(0.0f, 0.0f, -1.0f, 1.0f);  // clipped: a face without area has no patch
    uint patch_index = pattern.patch_of.at[face];
    if (patch_index == kNoTriangle) return;
    SurfaceVertex vertex =
        patch_vertex(pattern.mesh.at[0], patch_index, pattern.steps.at[gl_VertexIndex],
                     pattern.segments, uniform_levels());
    position = vertex.position;
    normal = vertex.normal;
    barycentrics = vertex.coordinates;
    gl_Position = clip_position(position);
}
