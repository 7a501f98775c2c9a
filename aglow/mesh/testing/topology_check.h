// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"

#include <algorithm>
#include <string>
#include <vector>

/// What must hold of every topology, for tests.
namespace aglow::mesh::testing {

/// The first thing that is wrong round a half-edge, or nothing.
inline std::string find_half_edge_fault(const Topology& t, uint32_t h) {
    if (t.previous(t.next(h)) != h || t.next(t.previous(h)) != h) return "next and previous differ";
    if (t.face[t.next(h)] != t.face[h]) return "next leaves the face";
    if (t.end(h) == t.vertex[h]) return "an edge has one end";
    const uint32_t edge = t.edge[h], twin = t.twin[h];
    if (edge >= t.edge_count()) return "an edge does not exist";
    if (t.edge_half[edge] != std::min(h, twin)) return "edge_half is not the first half-edge";
    if (twin == kNone) return "";
    if (t.twin[twin] != h) return "the twin of the twin is another";
    if (t.edge[twin] != edge) return "twins have two edges";
    if (t.vertex[twin] != t.end(h) || t.end(twin) != t.vertex[h]) return "twins do not meet";
    return "";
}

/// Turning counter-clockwise from vertex_half must meet all half-edges that start at the vertex.
inline std::string find_fan_fault(const Topology& t, uint32_t v, uint32_t valence) {
    const uint32_t first = t.vertex_half[v];
    if (first == kNone) return valence == 0 ? "" : "a vertex lost its faces";
    uint32_t met = 0, h = first;
    do {
        if (t.vertex[h] != v) return "a fan leaves its vertex";
        ++met;
        h = t.twin[t.previous(h)];
    } while (h != kNone && h != first && met <= valence);
    if (met != valence) return "a fan is not all of its vertex";
    return t.on_boundary(v) == (h == kNone) ? "" : "a fan starts in its middle";
}

inline std::string find_topology_fault(const Topology& t) {
    if (t.face.size() != t.vertex.size() || t.twin.size() != t.vertex.size() ||
        t.edge.size() != t.vertex.size() || t.face_begin.back() != t.vertex.size())
        return "half-edge arrays differ in size";
    if (t.edge_sharpness.size() != t.edge_half.size()) return "sharpness of edges has another size";
    if (t.vertex_sharpness.size() != t.vertex_half.size() ||
        t.source_vertex.size() != t.vertex_half.size())
        return "vertex arrays differ in size";
    if (t.source_face.size() != t.face_count()) return "source_face has another size";
    std::vector<uint32_t> valence(t.vertex_count(), 0);
    for (uint32_t f = 0; f < t.face_count(); ++f) {
        std::vector<uint32_t> corners(t.vertex.begin() + t.face_begin[f],
                                      t.vertex.begin() + t.face_begin[f + 1]);
        if (corners.size() < 3) return "a face has less than three corners";
        for (const uint32_t v : corners) {
            if (v >= t.vertex_count()) return "a vertex does not exist";
            ++valence[v];
        }
        std::sort(corners.begin(), corners.end());
        if (std::adjacent_find(corners.begin(), corners.end()) != corners.end())
            return "a face has a corner twice";
    }
    for (uint32_t h = 0; h < t.half_edge_count(); ++h)
        if (std::string fault = find_half_edge_fault(t, h); !fault.empty()) return fault;
    for (uint32_t v = 0; v < t.vertex_count(); ++v)
        if (std::string fault = find_fan_fault(t, v, valence[v]); !fault.empty()) return fault;
    return "";
}

/// Vertices with faces - edges + faces.
inline int euler_characteristic(const Topology& t) {
    const auto used = std::ranges::count_if(t.vertex_half, [](uint32_t h) { return h != kNone; });
    return static_cast<int>(used) - static_cast<int>(t.edge_count()) +
           static_cast<int>(t.face_count());
}

inline uint32_t boundary_edge_count(const Topology& t) {
    return static_cast<uint32_t>(
        std::ranges::count_if(t.edge_half, [&](uint32_t h) { return t.twin[h] == kNone; }));
}

}  // namespace aglow::mesh::testing
