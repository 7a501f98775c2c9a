// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/refine/displacement.h"
#include "aglow/refine/lod.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

/// What displaces a part of a mesh.
struct DetailSource {
    const HeightMap* map = nullptr;  ///< null: nothing does
    float scale = 1;                 ///< m that a height of 1 makes
};

/// How finely the edges of a displaced mesh of triangles have to be refined to show its heights:
/// by how much a face is off at most, between the texels of its map and vertices with 2^k segments
/// to an edge, each at a mip level that fits; of an edge the larger of its faces'.
/// Shapes  uvs [half-edge]; source_of [vertex] in `sources`, of all faces round it; result [edge]
/// Cost    O(texels), at most 128 of them along an edge
std::vector<EdgeDetail> edge_details(const Topology& topology, std::span<const vec2> uvs,
                                     std::span<const uint32_t> source_of,
                                     std::span<const DetailSource> sources);

/// [edge] How many texels of level 0 it is long, on the side where it is longer; 0 where nothing
/// displaces it. Shapes as above.
std::vector<float> edge_texels(const Topology& topology, std::span<const vec2> uvs,
                               std::span<const uint32_t> source_of,
                               std::span<const DetailSource> sources);

}  // namespace aglow
