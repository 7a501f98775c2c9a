// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/scene/refined_surface.h"

namespace aglow::refine {

/// Heights of a map, the mean of all vertices on one place, so that nothing opens. Texels are taken
/// as coarse as the vertices are apart.
/// Shapes  uvs [refined vertex], result [refined vertex]
std::vector<float> map_heights(const RefinedSurface& surface,
                               const HeightDisplacement& displacement, std::span<const vec2> uvs);

/// Moves a refined surface by heights that are alike on one place, along the mean of the normals
/// there. Normals become those of the triangles there, weighted by angle, and part where they did
/// before.
/// Shapes  heights [refined vertex]
void displace(const RefinedSurface& surface, std::span<const float> heights, RefinedShape& shape);

}  // namespace aglow::refine
