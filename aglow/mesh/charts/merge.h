// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/soup.h"

#include <vector>

namespace aglow::mesh {

/// A flat region and the segment it belongs to.
struct SegmentPatch {
    Point3 normal;
    double area = 0;
    uint32_t segment = 0;
};

/// Joins segments, the smallest first, each to the neighbour it touches most, as long as all
/// normals of the union stay within `cone` radians of their mean. Growing leaves scraps between
/// large segments; every scrap would cost a gutter. Shapes  beside[patch] lists the patches next to
/// it; the result is the segment of each patch.
std::vector<uint32_t> merge_segments(const std::vector<SegmentPatch>& patches,
                                     const std::vector<std::vector<uint32_t>>& beside,
                                     uint32_t segment_count, double cone);

}  // namespace aglow::mesh
