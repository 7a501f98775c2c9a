// SPDX-License-Identifier: Apache-2.0
// Vertices of the nested pattern, of which each face's instance has as much as its finest edge
// takes.
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

uint segments_of(PatchLevels levels) {
    uint a = edge_segments(levels.edge[0], 0u);
    uint b = edge_segments(levels.edge[1], 0u);
    uint c = edge_segments(levels.edge[2], 0u);
    return max(a, max(b, c));
}

// Steps of a vertex; what is beyond the pattern goes to the rim so that its triangles vanish.
uint within(uint steps, uint segments) {
    uint i = min(steps & 0xffffu, segments);
    uint j = min(steps >> 16u, segments - i);
    return i + (j << 16u);
}

void main() {
    RasterAdaptive pattern = RasterAdaptivePtr(args.geometry).at[0];
    face = face_at(uint(gl_InstanceIndex));
    position = normal = vec3(0.0f);
    barycentrics = vec2(0.0f);
    gl_Position = vec4(0.0f, 0.0f, -1.0f, 1.0f);  // clipped: a face without area has no patch
    uint patch_index = pattern.patch_of.at[face];
    if (patch_index == kNoTriangle) return;
    PatchLevels levels = pattern.levels.at[patch_index];
    uint segments = segments_of(levels);
    SurfaceVertex vertex =
        patch_vertex(pattern.mesh.at[0], patch_index,
                     within(pattern.steps.at[gl_VertexIndex], segments), segments, levels);
    position = vertex.position;
    normal = vertex.normal;
    barycentrics = vertex.coordinates;
    gl_Position = clip_position(position);
}
