// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/mesh/topology.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::mesh {

/// Triangles that make good quads, two by two: greedy, best pairs first.
/// Shapes  positions [vertex of triangles], joinable [edge]: which edges may become diagonals
/// Result  [face] the half-edge of the face across which its partner lies, or kNone
/// Cost    O(n log n)
std::vector<uint32_t> pair_triangles(const Topology& triangles, std::span<const vec3> positions,
                                     const std::vector<bool>& joinable);

}  // namespace aglow::mesh
