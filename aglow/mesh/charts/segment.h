// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/soup.h"

#include <span>
#include <vector>

namespace aglow::mesh {

struct SegmentLimits {
    double cone = 0.96;    ///< radians; largest angle between a normal and its segment's mean
    double crease = 0.87;  ///< radians; no segment crosses a sharper edge
};

/// Cuts some triangles of a mesh into edge-connected segments of similar normals: flat regions
/// are kept whole, segments grow from the largest flat region outwards, and small segments join a
/// neighbour where the limits allow it.
/// Shapes  every listed triangle is in exactly one segment; triangles that are points are in none.
/// Cost    O(n log n).   Repeat  a function of its arguments alone.
std::vector<std::vector<uint32_t>> segment(const Soup& soup, std::span<const uint32_t> triangles,
                                           const SegmentLimits& limits);

}  // namespace aglow::mesh
