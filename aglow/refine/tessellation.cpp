// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tessellation.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/pattern.h"
#include "aglow/shared/pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <utility>

namespace aglow {
namespace {

/// Where a pattern's vertex belongs: to an edge, the k-th from the corner it leaves; or inside.
struct Slot {
    uint32_t edge = shared::kInsidePattern;
    uint32_t place = 0;  ///< k on an edge; inside: which of the inner vertices
};

struct FacePattern {
    std::vector<Slot> slots;
    std::vector<uvec3> triangles;
};

Slot triangle_slot(uint32_t i, uint32_t j, uint32_t n) {
    if (j == 0) return {0, i};
    if (i == 0) return {2, n - j};
    if (i + j == n) return {1, j};
    return {};
}

Slot quad_slot(uint32_t i, uint32_t j, uint32_t n) {
    if (j == 0) return {0, i};
    if (i == n) return {1, j};
    if (j == n) return {2, n - i};
    if (i == 0) return {3, n - j};
    return {};
}

FacePattern face_pattern(uint32_t corners, uint32_t segments) {
    const int n = static_cast<int>(segments);
    Pattern pattern = corners == 3 ? triangle_pattern(n) : quad_pattern(n);
    FacePattern out;
    uint32_t inside = 0;
    for (const uint32_t steps : pattern.steps) {
        const uint32_t i = steps & 0xffffu, j = steps >> 16;
        Slot slot = corners == 3 ? triangle_slot(i, j, segments) : quad_slot(i, j, segments);
        if (slot.edge == shared::kInsidePattern) slot.place = inside++;
        out.slots.push_back(slot);
    }
    out.triangles = std::move(pattern.triangles);
    return out;
}

uint64_t inner_count(uint32_t corners, uint64_t n) {
    return corners == 3 ? (n - 1) * (n > 1 ? n - 2 : 0) / 2 : (n - 1) * (n - 1);
}

Status check_faces(const Topology& topology) {
    for (uint32_t f = 0; f < topology.face_count(); ++f)
        if (topology.face_size(f) > 4)
            return fail(Errc::bad_argument,
                        fmt::format("face {} has {} corners: patterns are for triangles and quads",
                                    f, topology.face_size(f)));
    return {};
}

uint32_t segments_of(const Tessellation& t, float level) {
    return shared::edge_segments(level, static_cast<uint32_t>(t.levels));
}

/// Numbers the vertices of edges and faces, whose levels are known.
Status number_vertices(const Topology& topology, Tessellation& t) {
    uint64_t next = topology.vertex_count();
    const auto number = [&](std::vector<uint32_t>& first, uint64_t count) {
        first.push_back(static_cast<uint32_t>(std::min<uint64_t>(next, UINT32_MAX)));
        next += count;
    };
    for (uint32_t e = 0; e < topology.edge_count(); ++e)
        number(t.edge_first, segments_of(t, t.edge_level[e]) - 1);
    number(t.edge_first, 0);
    for (uint32_t f = 0; f < topology.face_count(); ++f)
        number(t.face_first, inner_count(topology.face_size(f), t.face_segments[f]));
    number(t.face_first, 0);
    if (next > uint64_t{1} << 31)
        return fail(Errc::bad_argument,
                    fmt::format("{} refined vertices are too many: take a lower level", next));
    return {};
}

/// The refined vertex that stands for vertex k of a face's pattern along the half-edge h.
uint32_t edge_vertex(const Topology& topology, const Tessellation& t, uint32_t h, uint32_t k,
                     uint32_t segments) {
    const uint32_t e = topology.edge[h], half = topology.edge_half[e];
    const uint32_t own = segments_of(t, t.edge_level[e]);
    const uint32_t i = shared::snapped(half == h ? k : segments - k, segments, own,
                                       static_cast<uint32_t>(t.levels));
    if (i == 0) return topology.vertex[half];
    return i == own ? topology.end(half) : t.edge_first[e] + i - 1;
}

/// Appends the triangles of face f that do not vanish.
void add_triangles(const Topology& topology, const FacePattern& pattern, uint32_t f,
                   std::vector<uint32_t>& vertices, Tessellation& t) {
    vertices.clear();
    for (const Slot slot : pattern.slots)
        vertices.push_back(slot.edge == shared::kInsidePattern
                               ? t.face_first[f] + slot.place
                               : edge_vertex(topology, t, topology.face_begin[f] + slot.edge,
                                             slot.place, t.face_segments[f]));
    for (const uvec3 p : pattern.triangles) {
        const uvec3 v = {vertices[p.x], vertices[p.y], vertices[p.z]};
        if (v.x != v.y && v.y != v.z && v.z != v.x) t.triangles.push_back(v);
    }
    t.face_triangle.push_back(static_cast<uint32_t>(t.triangles.size()));
}

Result<Tessellation> finished(const Topology& topology, Tessellation t) {
    AG_CHECK(number_vertices(topology, t));
    t.vertex_half = topology.vertex_half;
    t.edge_half = topology.edge_half;
    t.edge = topology.edge;
    std::map<std::pair<uint32_t, uint32_t>, FacePattern> patterns;
    std::vector<uint32_t> vertices;
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        const std::pair key(topology.face_size(f), uint32_t{t.face_segments[f]});
        auto found = patterns.find(key);
        if (found == patterns.end())
            found = patterns.emplace(key, face_pattern(key.first, key.second)).first;
        add_triangles(topology, found->second, f, vertices, t);
    }
    return t;
}

/// The pattern of a face whose finest edge has this level.
void set_face(Tessellation& t, uint32_t f, float finest) {
    const uint32_t n = segments_of(t, finest);
    t.face_segments[f] = static_cast<uint16_t>(n);
    t.face_inner[f] =
        t.levels == Tessellation::Levels::continuous ? shared::level_weight(finest, n) : 1.0f;
}

}  // namespace

Result<Tessellation> Tessellation::uniform(const Topology& topology, int segments) {
    if (segments < 1 || segments > kMostSegments)
        return fail(Errc::bad_argument,
                    fmt::format("{} segments: an edge has 1 to {}", segments, kMostSegments));
    AG_CHECK(check_faces(topology));
    Tessellation t;
    t.segments = segments;
    t.edge_level.assign(topology.edge_count(), static_cast<float>(segments));
    t.face_segments.assign(topology.face_count(), static_cast<uint16_t>(segments));
    t.face_inner.assign(topology.face_count(), 1.0f);
    return finished(topology, std::move(t));
}

Result<Tessellation> Tessellation::adaptive(const Topology& topology, std::span<const float> levels,
                                            Levels kind) {
    AG_ASSERT(levels.size() == topology.edge_count(), "one level per edge");
    AG_CHECK(check_faces(topology));
    for (const float level : levels)
        if (!(level >= 1 && level <= kMostAdaptiveSegments))
            return fail(Errc::bad_argument, fmt::format("an edge's level is {}: it must be 1 to {}",
                                                        level, kMostAdaptiveSegments));
    Tessellation t;
    t.levels = kind;
    t.edge_level.assign(levels.begin(), levels.end());
    t.face_segments.resize(topology.face_count());
    t.face_inner.resize(topology.face_count());
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        float finest = 1;
        for (uint32_t h = topology.face_begin[f]; h < topology.face_begin[f + 1]; ++h)
            finest = std::max(finest, levels[topology.edge[h]]);
        set_face(t, f, finest);
    }
    return finished(topology, std::move(t));
}

std::vector<uint32_t> refined_sources(const Topology& cut_topology, const Tessellation& cut,
                                      const Topology& whole_topology, const Tessellation& whole) {
    AG_ASSERT(cut_topology.half_edge_count() == whole_topology.half_edge_count(), "same corners");
    std::vector<uint32_t> sources(cut.vertex_count());
    for (uint32_t h = 0; h < cut_topology.half_edge_count(); ++h)
        sources[cut_topology.vertex[h]] = whole_topology.vertex[h];
    for (uint32_t e = 0; e < cut_topology.edge_count(); ++e) {
        const uint32_t h = cut.edge_half[e], from = whole_topology.edge[h];
        const uint32_t first = cut.edge_first[e], count = cut.edge_first[e + 1] - first;
        const bool same_way = whole.edge_half[from] == h;
        for (uint32_t i = 0; i < count; ++i)
            sources[first + i] = whole.edge_first[from] + (same_way ? i : count - 1 - i);
    }
    for (uint32_t v = cut.face_first.front(); v < cut.vertex_count(); ++v)
        sources[v] = v - cut.face_first.front() + whole.face_first.front();
    return sources;
}

}  // namespace aglow
