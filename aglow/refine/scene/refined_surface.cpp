// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/refined_surface.h"

namespace aglow::refine {

std::vector<uint32_t> RefinedSurface::edge_vertices(uint32_t half_edge) const {
    const uint32_t e = cut.edge[half_edge], along = cut.edge_half[e];
    std::vector<uint32_t> vertices = {cut.vertex[along]};
    for (uint32_t v = order.edge_first[e]; v < order.edge_first[e + 1]; ++v) vertices.push_back(v);
    vertices.push_back(cut.end(along));
    return vertices;
}

}  // namespace aglow::refine
