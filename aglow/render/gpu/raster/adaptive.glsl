// SPDX-License-Identifier: Apache-2.0
// Vertices of patterns of which each face has as much as its finest edge takes, on curved patches.
#include "aglow/render/gpu/raster/raster.glsl"
#include "aglow/shared/raster_pattern.h"

layout(constant_id = 2) const uint kPatchDisplacement = kNoDisplacement;
const uint kPatchCorners = 3u;
#include "aglow/refine/gpu/patch_surface.glsl"

RasterPattern drawn_pattern() { return RasterPatternPtr(args.geometry).at[0]; }

uint segments_of(PatchLevels levels) {
    uint a = edge_segments(levels.edge[0], 0u);
    uint b = edge_segments(levels.edge[1], 0u);
    uint c = edge_segments(levels.edge[2], 0u);
    return max(a, max(b, c));
}

// What is beyond the face's pattern goes to the rim, so that its triangles vanish.
uint folded(uint steps, uint segments) {
    uint i = min(steps & 0xffffu, segments);
    uint j = min(steps >> 16u, segments - i);
    return i + (j << 16u);
}

SurfaceVertex face_vertex(RasterPattern pattern, uint patch_index, uint steps) {
    PatchLevels levels = pattern.levels.at[patch_index];
    uint segments = segments_of(levels);
    return patch_vertex(pattern.mesh.at[0], patch_index, folded(steps, segments), segments, levels);
}
