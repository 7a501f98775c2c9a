// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/topology.h"

#include "aglow/core/assert.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>

namespace aglow {
namespace {

constexpr const char* kNoMemory = "the topology of a mesh does not fit into memory";
constexpr size_t kMostCorners = size_t{1} << 31;

Status check(const PolygonList& polygons, std::span<const Crease> creases) {
    AG_ASSERT(polygons.face_begin.front() == 0, "faces start at the first corner");
    AG_ASSERT(polygons.face_begin.back() == polygons.corners.size(), "faces end at the last");
    if (polygons.corners.size() > kMostCorners)
        return fail(Errc::bad_argument, "a mesh has more than 2^31 corners");
    const auto beyond = std::ranges::find_if(
        polygons.corners, [&](uint32_t v) { return v >= polygons.vertex_count; });
    if (beyond != polygons.corners.end())
        return fail(Errc::bad_argument,
                    fmt::format("corner {} is vertex {}, but there are {}",
                                beyond - polygons.corners.begin(), *beyond, polygons.vertex_count));
    for (size_t i = 0; i < creases.size(); ++i) {
        if (std::max(creases[i].a, creases[i].b) >= polygons.vertex_count)
            return fail(Errc::bad_argument,
                        fmt::format("crease {} runs from vertex {} to {}, but there are {}", i,
                                    creases[i].a, creases[i].b, polygons.vertex_count));
        if (!(creases[i].sharpness >= 0))
            return fail(Errc::bad_argument,
                        fmt::format("crease {} has the sharpness {}", i, creases[i].sharpness));
    }
    return {};
}

/// The half-edges of all faces, sorted by the ends of their edge.
struct SortedHalfEdges {
    /// [vertex + 1] Those of begin[v] .. begin[v + 1] have v as the lower-numbered end.
    std::vector<uint32_t> begin;
    std::vector<uint64_t> entries;  ///< the other end in the upper 32 bits, the half-edge below

    static uint32_t end(uint64_t entry) { return static_cast<uint32_t>(entry >> 32); }
    static uint32_t half_edge(uint64_t entry) { return static_cast<uint32_t>(entry); }
    static uint64_t key(uint32_t end) { return uint64_t{end} << 32; }

    std::span<const uint64_t> of(uint32_t v) const {
        return std::span(entries).subspan(begin[v], begin[v + 1] - begin[v]);
    }
};

/// In the order of their half-edges: the edges of a face lie close to each other.
void number_edges(Topology& mesh) {
    const uint32_t count = mesh.half_edge_count();
    mesh.edge.resize(count);
    mesh.edge_half.reserve(count);
    for (uint32_t h = 0; h < count; ++h) {
        const uint32_t twin = mesh.twin[h];
        if (twin < h) {
            mesh.edge[h] = mesh.edge[twin];
            continue;
        }
        mesh.edge[h] = mesh.edge_count();
        mesh.edge_half.push_back(h);
    }
}

/// Gives the fan of half-edge `first` the vertex that it has, or another where a fan has that.
void walk_fan(Topology& mesh, uint32_t first, std::vector<bool>& met) {
    uint32_t v = mesh.vertex[first];
    if (mesh.vertex_half[v] != kNone) {
        mesh.source_vertex.push_back(v);
        v = mesh.vertex_count();
        mesh.vertex_half.push_back(kNone);
    }
    mesh.vertex_half[v] = first;
    uint32_t h = first;
    do {
        met[h] = true;
        mesh.vertex[h] = v;
        h = mesh.twin[mesh.previous(h)];
    } while (h != kNone && h != first);
}

/// Gives every fan a vertex of its own. Result: how many had to be added.
uint32_t part_fans(Topology& mesh, uint32_t vertex_count) {
    mesh.vertex_half.assign(vertex_count, kNone);
    mesh.source_vertex.resize(vertex_count);
    std::iota(mesh.source_vertex.begin(), mesh.source_vertex.end(), 0u);
    std::vector<bool> met(mesh.half_edge_count(), false);
    // An open fan is met from its end, so those come first; what is left is closed.
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
        if (mesh.twin[h] == kNone) walk_fan(mesh, h, met);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
        if (!met[h]) walk_fan(mesh, h, met);
    return mesh.vertex_count() - vertex_count;
}

Topology make_seams(const Topology& mesh, std::span<const uint32_t> corners,
                    uint32_t vertex_count) {
    Topology seams;
    seams.face_begin = mesh.face_begin;
    seams.face = mesh.face;
    seams.source_face = mesh.source_face;
    seams.vertex.assign(corners.begin(), corners.end());
    seams.twin = mesh.twin;
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
        const uint32_t twin = mesh.twin[h];
        if (twin != kNone &&
            (corners[h] != corners[mesh.next(twin)] || corners[mesh.next(h)] != corners[twin]))
            seams.twin[h] = kNone;
    }
    number_edges(seams);
    for (const uint32_t h : seams.edge_half)
        seams.edge_sharpness.push_back(mesh.edge_sharpness[mesh.edge[h]]);
    part_fans(seams, vertex_count);
    for (const uint32_t h : seams.vertex_half)
        seams.vertex_sharpness.push_back(h == kNone ? 0 : mesh.vertex_sharpness[mesh.vertex[h]]);
    return seams;
}

class Builder {
public:
    Builder(const PolygonList& polygons, std::span<const Crease> creases)
        : polygons_(polygons), creases_(creases) {}

    TopologyResult build() {
        keep_faces();
        sort_half_edges();
        pair_half_edges();
        number_edges(mesh_);
        sharpen_edges();
        repairs_.split_vertices = part_fans(mesh_, polygons_.vertex_count);
        mesh_.vertex_sharpness.assign(mesh_.vertex_count(), 0.0f);
        return {std::move(mesh_), repairs_};
    }

private:
    /// Faces without their repeated corners, if three are left.
    void keep_faces() {
        mesh_.vertex.reserve(polygons_.corners.size());
        mesh_.face.reserve(polygons_.corners.size());
        mesh_.face_begin.reserve(polygons_.face_begin.size());
        mesh_.source_face.reserve(polygons_.face_count());
        std::vector<uint32_t> last_face(polygons_.vertex_count, kNone);
        for (uint32_t f = 0; f < polygons_.face_count(); ++f) {
            const auto first = static_cast<uint32_t>(mesh_.vertex.size());
            for (uint32_t c = polygons_.face_begin[f]; c < polygons_.face_begin[f + 1]; ++c) {
                const uint32_t v = polygons_.corners[c];
                if (last_face[v] == f) continue;
                last_face[v] = f;
                mesh_.vertex.push_back(v);
            }
            if (mesh_.vertex.size() - first < 3) {
                mesh_.vertex.resize(first);
                ++repairs_.dropped_faces;
                continue;
            }
            mesh_.face.resize(mesh_.vertex.size(), mesh_.face_count());
            mesh_.face_begin.push_back(static_cast<uint32_t>(mesh_.vertex.size()));
            mesh_.source_face.push_back(f);
        }
    }

    /// Counts, then scatters, by the lower end; by the other end within these few.
    void sort_half_edges() {
        const uint32_t count = mesh_.half_edge_count();
        std::vector<uint32_t>& begin = sorted_.begin;
        begin.assign(size_t{polygons_.vertex_count} + 2, 0);
        for (uint32_t h = 0; h < count; ++h)
            ++begin[size_t{std::min(mesh_.vertex[h], mesh_.end(h))} + 2];
        for (size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
        sorted_.entries.resize(count);
        for (uint32_t h = 0; h < count; ++h) {
            const uint32_t a = mesh_.vertex[h], b = mesh_.end(h);
            sorted_.entries[begin[size_t{std::min(a, b)} + 1]++] =
                SortedHalfEdges::key(std::max(a, b)) | h;
        }
        begin.pop_back();
        for (uint32_t v = 0; v < polygons_.vertex_count; ++v)
            std::sort(sorted_.entries.begin() + begin[v], sorted_.entries.begin() + begin[v + 1]);
    }

    /// Two half-edges that run along an edge in opposite directions are twins; every other number
    /// of faces cuts the edge.
    void pair_half_edges() {
        mesh_.twin.assign(mesh_.half_edge_count(), kNone);
        for (uint32_t v = 0; v < polygons_.vertex_count; ++v) {
            const std::span<const uint64_t> entries = sorted_.of(v);
            for (size_t i = 0, next = 0; i < entries.size(); i = next) {
                while (next < entries.size() &&
                       SortedHalfEdges::end(entries[next]) == SortedHalfEdges::end(entries[i]))
                    ++next;
                if (next - i == 1) continue;
                const uint32_t g = SortedHalfEdges::half_edge(entries[i]);
                const uint32_t h = SortedHalfEdges::half_edge(entries[i + 1]);
                if (next - i > 2 || mesh_.vertex[g] == mesh_.vertex[h]) {
                    ++repairs_.cut_edges;
                    continue;
                }
                mesh_.twin[g] = h;
                mesh_.twin[h] = g;
            }
        }
    }

    void sharpen_edges() {
        mesh_.edge_sharpness.assign(mesh_.edge_count(), 0.0f);
        for (const Crease& crease : creases_) {
            const uint32_t end = std::max(crease.a, crease.b);
            const std::span<const uint64_t> entries = sorted_.of(std::min(crease.a, crease.b));
            auto entry = std::ranges::lower_bound(entries, SortedHalfEdges::key(end));
            if (entry == entries.end() || SortedHalfEdges::end(*entry) != end)
                ++repairs_.stray_creases;
            for (; entry != entries.end() && SortedHalfEdges::end(*entry) == end; ++entry) {
                float& sharpness =
                    mesh_.edge_sharpness[mesh_.edge[SortedHalfEdges::half_edge(*entry)]];
                sharpness = std::max(sharpness, crease.sharpness);
            }
        }
    }

    const PolygonList& polygons_;
    std::span<const Crease> creases_;
    SortedHalfEdges sorted_;
    Topology mesh_;
    Repairs repairs_;
};

}  // namespace

Result<TopologyResult> build_topology(const PolygonList& polygons,
                                      std::span<const Crease> creases) {
    AG_CHECK(check(polygons, creases));
    try {
        return Builder(polygons, creases).build();
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, kNoMemory);
    }
}

Result<Topology> cut_seams(const Topology& topology, std::span<const uint32_t> corners,
                           uint32_t vertex_count) {
    AG_ASSERT(corners.size() == topology.half_edge_count(), "every corner has a vertex");
    try {
        return make_seams(topology, corners, vertex_count);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, kNoMemory);
    }
}

}  // namespace aglow
