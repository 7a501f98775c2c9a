// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/refine/patches.h"
#include "aglow/render/gpu/raster/projection.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// Edges of which no face can be seen: all control points of the face are beyond one side of the
/// picture, or it is one-sided and faces away, by corners and middle, by more than 20 degrees.
/// Shapes  one_sided [face]; reach [face] m that displacement moves it at most, after which its
///         normals may be any, or empty; result [edge] 1: hidden
/// Cost    O(mesh)
std::vector<uint8_t> hidden_edges(const Topology& topology, const PatchControl& control,
                                  std::span<const uint8_t> one_sided, std::span<const float> reach,
                                  const Projection& projection);

}  // namespace aglow::render::gpu
