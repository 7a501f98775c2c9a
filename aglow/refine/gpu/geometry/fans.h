// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/shared/geometry_loop.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::refine::gpu {

/// What LoopArgs points to.
struct LoopFans {
    std::vector<shared::LoopVertex> vertices;
    std::vector<uint32_t> fans;
    std::vector<uint32_t> starts;
};

/// The neighbours of all vertices of a mesh of triangles, which are sharp only as kSharp vertices.
/// `points`: where the point of each vertex is; [vertex].
LoopFans loop_fans(const Topology& mesh, std::span<const uint32_t> points);

/// The triangles' corners; with adjacency six for each, between them the vertices opposite their
/// edges (on a boundary any).
std::vector<uint32_t> loop_indices(const Topology& mesh, bool adjacency);

}  // namespace aglow::refine::gpu
