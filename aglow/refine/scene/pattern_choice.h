// SPDX-License-Identifier: Apache-2.0
// Where patches get their vertices, if not evenly.
#pragma once
#include "aglow/refine/patches.h"

#include <optional>
#include <span>
#include <vector>

namespace aglow::refine {

/// Tessellation::density that puts vertices as densely as the square root of curvature, and of
/// nearness to the eye, beside the mean.
/// Shapes  control of the topology, result [vertex]
/// Source  de Boor, "Good Approximation by Splines with Variable Knots", 1973: pieces of equal
///         error are as long as the root of the second derivative is small.
std::vector<float> vertex_density(const Topology& topology, const PatchControl& control,
                                  const std::optional<vec3>& eye);

/// The fewest segments of each edge that keep it within `tolerance` of the smooth one, m; at most
/// `most`.
/// Shapes  result [edge]
std::vector<float> edge_levels(const Topology& topology, const PatchControl& control,
                               float tolerance, float most);

}  // namespace aglow::refine
