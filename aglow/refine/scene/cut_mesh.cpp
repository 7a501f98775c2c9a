// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/cut_mesh.h"

#include "aglow/core/assert.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace aglow::refine {
namespace {

uint32_t root_of(std::vector<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/// Refined vertices inside a face of so many corners, `n` segments to an edge.
uint64_t inner_count(Scheme scheme, uint64_t corners, uint64_t n) {
    if (scheme == Scheme::loop) return n > 2 ? (n - 1) * (n - 2) / 2 : 0;
    const uint64_t half = n / 2;  // each corner has a quad of so many segments
    return corners * half * (half - 1) + 1;
}

}  // namespace

std::vector<uint32_t> corner_groups(const Topology& topology,
                                    const std::function<bool(uint32_t, uint32_t)>& joined) {
    std::vector<uint32_t> parent(topology.half_edge_count());
    std::iota(parent.begin(), parent.end(), 0u);
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        if (topology.twin[h] == kNone) continue;
        const uint32_t other = topology.next(topology.twin[h]);
        if (!joined(h, other)) continue;
        const uint32_t a = root_of(parent, h), b = root_of(parent, other);
        parent[std::max(a, b)] = std::min(a, b);
    }
    for (uint32_t h = 0; h < parent.size(); ++h) parent[h] = root_of(parent, h);
    return parent;
}

Result<Topology> cut_by(const Topology& topology, std::span<const uint32_t> groups,
                        std::span<const uint32_t> other_groups) {
    std::unordered_map<uint64_t, uint32_t> number;
    std::vector<uint32_t> corners;
    corners.reserve(groups.size());
    for (size_t h = 0; h < groups.size(); ++h) {
        const uint64_t key = uint64_t{groups[h]} << 32 | other_groups[h];
        corners.push_back(
            number.try_emplace(key, static_cast<uint32_t>(number.size())).first->second);
    }
    return cut_seams(topology, corners, static_cast<uint32_t>(number.size()));
}

Tessellation subdivided_order(const Topology& topology, Scheme scheme, int level) {
    const uint32_t n = 1u << level;
    Tessellation order;
    order.segments = static_cast<int>(n);
    order.face_first.clear();
    uint64_t next = topology.vertex_count();
    for (uint32_t e = 0; e <= topology.edge_count(); ++e) {
        order.edge_first.push_back(static_cast<uint32_t>(next));
        if (e < topology.edge_count()) next += n - 1;
    }
    for (uint32_t f = 0; f <= topology.face_count(); ++f) {
        order.face_first.push_back(static_cast<uint32_t>(next));
        if (f < topology.face_count()) next += inner_count(scheme, topology.face_size(f), n);
    }
    order.vertex_half = topology.vertex_half;
    order.edge_half = topology.edge_half;
    order.edge = topology.edge;
    return order;
}

uint32_t CutNumbers::operator()(uint32_t face, uint32_t refined) const {
    if (refined >= whole_order_.face_first[face])
        return refined - whole_order_.face_first[face] + cut_order_.face_first[face];
    if (refined >= whole_.vertex_count()) return on_edge(face, refined);
    uint32_t h = whole_.face_begin[face];
    while (whole_.vertex[h] != refined) ++h;
    AG_ASSERT(h < whole_.face_begin[face + 1], "a corner of the face");
    return cut_.vertex[h];
}

uint32_t CutNumbers::on_edge(uint32_t face, uint32_t refined) const {
    const uint32_t count = static_cast<uint32_t>(whole_order_.segments) - 1;
    const uint32_t e = (refined - whole_.vertex_count()) / count;
    const uint32_t i = (refined - whole_.vertex_count()) % count;
    uint32_t h = whole_.face_begin[face];
    while (whole_.edge[h] != e) ++h;
    AG_ASSERT(h < whole_.face_begin[face + 1], "an edge of the face");
    const uint32_t cut_edge = cut_.edge[h];
    const bool same_way = (whole_.edge_half[e] == h) == (cut_.edge_half[cut_edge] == h);
    return cut_order_.edge_first[cut_edge] + (same_way ? i : count - 1 - i);
}

}  // namespace aglow::refine
