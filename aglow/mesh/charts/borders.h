// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/soup.h"

#include <vector>

namespace aglow::mesh {

inline constexpr uint32_t kNoSegment = 0xffffffffu;

/// Straightens the borders between segments: a movable triangle that shares more border with
/// another segment than with its own goes over to it, where its normal stays within `cone` of
/// that segment's mean. Ragged borders would waste texels in the slits between their teeth.
/// Shapes  segment_of[triangle] is kNoSegment for triangles that do not take part.
void smooth_borders(const Soup& soup, const std::vector<char>& movable, double cone,
                    std::vector<uint32_t>& segment_of);

/// Lists the edge-connected parts of every segment, in the order of their first triangles; each
/// list is sorted.
std::vector<std::vector<uint32_t>> connected_segments(const Soup& soup,
                                                      const std::vector<uint32_t>& segment_of);

}  // namespace aglow::mesh
