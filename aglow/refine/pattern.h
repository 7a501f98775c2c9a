// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <cstdint>
#include <vector>

namespace aglow {

/// The finest pattern, segments per edge.
inline constexpr int kMostSegments = 256;
/// The finest level of an edge where each has its own.
inline constexpr int kMostAdaptiveSegments = 128;

/// A refined polygon, stored once and drawn in place of every coarse one: its vertices hold where
/// in the polygon they are, and control data of the coarse polygon say where that is in space.
/// Source  Boubekeur & Schlick, "Generic Mesh Refinement on GPU", Graphics Hardware 2005.
struct Pattern {
    /// [vertex_count] A triangle's barycentrics of corners 1 and 2 (corner 0 has 1 - x - y); of a
    /// quad, x along the edge from corner 0 to 1 and y from 0 to 3.
    std::vector<vec2> coordinates;
    /// [vertex_count] The same in steps: i + (j << 16) for coordinates (i, j) / segments. What
    /// triangle_pattern_point() and quad_pattern_point() of aglow/shared/pattern.h take.
    std::vector<uint32_t> steps;
    std::vector<uvec3> triangles;  ///< [triangle_count] counter-clockwise
};

/// `segments` to an edge, all triangles of one shape. Vertices come in rows of equal y.
/// Shapes  segments in 1..kMostSegments; (segments + 1)(segments + 2) / 2 vertices, segments^2
///         triangles.
Pattern triangle_pattern(int segments);

/// Likewise for quads: (segments + 1)^2 vertices, 2 segments^2 triangles.
Pattern quad_pattern(int segments);

/// triangle_pattern(n) of all n up to `segments` in one: its first n^2 triangles are those of n,
/// and its first (n + 1)(n + 2) / 2 vertices are theirs. Without coordinates, which depend on n.
/// Shapes  as triangle_pattern(segments)
Pattern nested_triangle_pattern(int segments);

}  // namespace aglow
