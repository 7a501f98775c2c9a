// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/scene/refined_surface.h"

namespace aglow::refine {

/// Moves a refined surface along its normals by a height map. Vertices on one place move alike,
/// along the mean of their normals by the mean of their heights, so that nothing opens. Normals
/// become those of the triangles there, weighted by angle, and part where they did before.
/// Texels of the map are taken as coarse as the vertices are apart.
/// Shapes  uvs [refined vertex]
void displace(const RefinedSurface& surface, const HeightDisplacement& displacement,
              std::span<const vec2> uvs, RefinedShape& shape);

}  // namespace aglow::refine
