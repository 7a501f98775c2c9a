// SPDX-License-Identifier: Apache-2.0
// Vertices of a pattern whose edges all have its segments, on curved patches over faces.
#include "aglow/render/gpu/raster/raster.glsl"
#include "aglow/shared/raster_pattern.h"

layout(constant_id = 2) const uint kPatchDisplacement = kNoDisplacement;
const uint kPatchCorners = 3u;
#include "aglow/refine/gpu/patch_surface.glsl"

RasterPattern drawn_pattern() { return RasterPatternPtr(args.geometry).at[0]; }

SurfaceVertex face_vertex(RasterPattern pattern, uint patch_index, uint steps) {
    return patch_vertex(pattern.mesh.at[0], patch_index, steps, args.segments, uniform_levels());
}
