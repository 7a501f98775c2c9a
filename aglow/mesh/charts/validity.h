// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/chart.h"

namespace aglow::mesh {

struct StretchLimits {
    double scale = 1.9;   ///< largest linear magnification or reduction of a triangle
    double aspect = 2.2;  ///< largest ratio of the two principal stretches of a triangle
};

/// Whether every triangle (slivers aside) keeps its orientation and is stretched within limits.
bool stretch_is_bounded(const Soup& soup, const Chart& chart, const StretchLimits& limits);

/// Whether the chart overlaps itself, once all its triangles have one orientation: looks for
/// crossing borders, then for texels of a grid as fine as the triangles that lie in two of them.
/// Cost  O(n log n) for charts whose borders are not tangled.
bool overlaps_itself(const Chart& chart);

/// Whether any two of the triangles share area, judged at the centres of a grid over their box of
/// `resolution` cells a side; triangles that merely touch do not overlap.
bool any_overlap(const std::vector<Triangle2>& triangles, int resolution);

/// Largest linear scale and ratio of principal stretches of the map from a triangle to the plane.
struct Stretch {
    double scale = 1;   ///< square root of the area's magnification; negative where turned over
    double aspect = 1;  ///< ratio of principal stretches, >= 1
};
Stretch stretch_of(const Soup& soup, uint32_t triangle, const Triangle2& flat);

}  // namespace aglow::mesh
