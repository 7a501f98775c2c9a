// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <span>
#include <vector>

namespace aglow::obj {

/// Cuts a simple polygon, which need not be convex and only about planar, into size - 2 triangles
/// with the polygon's orientation. What is not simple is cut too, if not prettily.
/// Shapes  result indexes `corners`.
/// Cost    O(n^2) for convex polygons, O(n^3) at worst.
/// Source  Meisters, "Polygons Have Ears", American Mathematical Monthly, 1975.
std::vector<uvec3> triangulate(std::span<const vec3> corners);

}  // namespace aglow::obj
