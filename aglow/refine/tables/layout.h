// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/tables/state.h"

#include <cstdint>
#include <vector>

namespace aglow::refine {

/// Where the refined vertices of a mesh are: that which a vertex becomes, the first of those along
/// an edge in the direction of edge_half, the first of those inside a face.
struct Layout {
    uint32_t segments = 1;         ///< per edge; 0: of the vertices alone, and they do not move
    std::vector<uint32_t> vertex;  ///< kNone: is no refined vertex
    std::vector<uint32_t> edge;
    std::vector<uint32_t> face;
};

/// How many refined vertices a mesh has; 64 bits, since it may be too many.
uint64_t refined_count(const Topology& mesh, Scheme scheme, uint64_t segments);

/// Of the control mesh: vertices, then edges, then faces.
Layout control_layout(const Topology& mesh, Scheme scheme, uint32_t segments);

/// Of split(mesh), with half as many segments: its points are among those of `coarse`. Inside a
/// face there come the middle one, those along the inner edges, and those of the children's
/// insides.
Layout split_layout(const Topology& mesh, Scheme scheme, const Layout& coarse);

/// What every face writes: the corners and edges of which it has vertex_half and edge_half.
std::vector<FaceOutput> face_outputs(const Topology& mesh, const Layout& layout);

}  // namespace aglow::refine
