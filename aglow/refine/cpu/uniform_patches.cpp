// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/cpu/uniform_patches.h"

#include "aglow/core/parallel.h"
#include "aglow/core/target_clones.h"
#include "aglow/refine/cpu/patch_faces.h"
#include "aglow/refine/cpu/stream_writer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace aglow::refine::cpu {
namespace {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));

/// Floats that loops work on at a time: eight points x, y, z. Rows are computed in whole steps;
/// what lies beyond their ends is overwritten by what follows.
constexpr size_t kStep = 24;

Four four(vec3 v) {
    const Four r = {v.x, v.y, v.z, 0};
    return r;
}

/// A coefficient of a polynomial in space, as often as there are points in a step.
struct Spread {
    Eight part[3];
};

[[gnu::always_inline]] inline void spread(Four v, Spread& to) {
    to.part[0] = __builtin_shufflevector(v, v, 0, 1, 2, 0, 1, 2, 0, 1);
    to.part[1] = __builtin_shufflevector(v, v, 2, 0, 1, 2, 0, 1, 2, 0);
    to.part[2] = __builtin_shufflevector(v, v, 1, 2, 0, 1, 2, 0, 1, 2);
}

/// k / n for k = 1 .., each three times, padded to whole steps.
std::vector<float> parameters(size_t n) {
    std::vector<float> table;
    for (size_t k = 1; k < n + kStep; ++k)
        table.insert(table.end(), 3, static_cast<float>(k) / static_cast<float>(n));
    return table;
}

/// The polynomial of a row's points in x.
struct RowPowers {
    Four c0, c1, c2, c3;
};

/// That of a triangle in powers x^i y^j.
struct TrianglePowers {
    Four c00, c01, c02, c03, c10, c11, c12, c20, c21, c30;
};

TrianglePowers powers(const shared::PatchPoints& c) {
    std::array<Four, 10> p;
    for (size_t i = 0; i < 10; ++i) p[i] = four(c.p[i]);
    return {.c00 = p[0],
            .c01 = (p[8] - p[0]) * 3,
            .c02 = (p[0] - p[8] * 2 + p[7]) * 3,
            .c03 = p[2] - p[0] + (p[8] - p[7]) * 3,
            .c10 = (p[3] - p[0]) * 3,
            .c11 = (p[0] - p[3] - p[8] + p[9]) * 6,
            .c12 = (p[8] * 2 - p[0] - p[7] + p[3] - p[9] * 2 + p[6]) * 3,
            .c20 = (p[0] - p[3] * 2 + p[4]) * 3,
            .c21 = (p[3] * 2 - p[0] - p[4] + p[8] - p[9] * 2 + p[5]) * 3,
            .c30 = p[1] - p[0] + (p[3] - p[4]) * 3};
}

/// `count` points at the parameters `x`. Inlined, so that it is compiled for each processor.
[[gnu::always_inline]] inline void write_row(const RowPowers& row, const float* x, size_t count,
                                             float* out) {
    Spread c0, c1, c2, c3;
    spread(row.c0, c0);
    spread(row.c1, c1);
    spread(row.c2, c2);
    spread(row.c3, c3);
    for (size_t begin = 0; begin < 3 * count; begin += kStep)
        for (size_t i = 0; i < 3; ++i) {
            Eight t;
            std::memcpy(&t, x + begin + 8 * i, sizeof t);
            const Eight p = ((c3.part[i] * t + c2.part[i]) * t + c1.part[i]) * t + c0.part[i];
            std::memcpy(out + begin + 8 * i, &p, sizeof p);
        }
}

AGLOW_TARGET_CLONES
void write_triangle(const TrianglePowers& c, const float* x, size_t n, StreamWriter& writer) {
    for (size_t j = 1; j + 1 < n; ++j) {
        const float y = x[3 * (j - 1)];
        const RowPowers row = {((c.c03 * y + c.c02) * y + c.c01) * y + c.c00,
                               (c.c12 * y + c.c11) * y + c.c10, c.c21 * y + c.c20, c.c30};
        const size_t count = n - 1 - j;
        write_row(row, x, count, writer.room());
        writer.commit(3 * count);
    }
}

AGLOW_TARGET_CLONES
void write_edge(const RowPowers& row, const float* t, size_t count, StreamWriter& writer) {
    write_row(row, t, count, writer.room());
    writer.commit(3 * count);
}

/// Of an edge's cubic, from its end with the lower number.
RowPowers edge_powers(vec3 from, const shared::EdgePoints& e, vec3 to) {
    const Four a = four(from), f = four(e.first), g = four(e.second), b = four(to);
    return {a, (f - a) * 3, (a - f * 2 + g) * 3, b - a + (f - g) * 3};
}

struct Tables {
    std::vector<float> rising, falling;  ///< k / n for k = 1 .. n - 1 and back
};

Tables tables_for(size_t n) {
    Tables t;
    t.rising = parameters(n);
    t.falling.assign(t.rising.size(), 0.0f);
    for (size_t i = 0; i + 1 < n; ++i)
        for (size_t c = 0; c < 3; ++c) t.falling[3 * i + c] = t.rising[3 * (n - 2 - i)];
    return t;
}

void write_edges(const Topology& topology, const PatchControl& control,
                 const Tessellation& tessellation, const Tables& tables, size_t begin, size_t end,
                 vec3* positions) {
    StreamWriter writer(&positions[tessellation.edge_first[begin]].x);
    for (size_t e = begin; e < end; ++e) {
        const uint32_t h = tessellation.edge_half[e];
        const uint32_t from = topology.vertex[h], to = topology.end(h);
        const RowPowers row =
            edge_powers(control.positions[std::min(from, to)], control.edges[topology.edge[h]],
                        control.positions[std::max(from, to)]);
        write_edge(row, (from < to ? tables.rising : tables.falling).data(),
                   static_cast<size_t>(tessellation.segments - 1), writer);
    }
}

/// Faces begin .. end, all of them triangles.
void write_triangles(const Topology& topology, const PatchControl& control,
                     const Tessellation& tessellation, const Tables& tables, size_t begin,
                     size_t end, vec3* positions) {
    StreamWriter writer(&positions[tessellation.face_first[begin]].x);
    for (size_t f = begin; f < end; ++f)
        write_triangle(powers(triangle_points(topology, control, static_cast<uint32_t>(f))),
                       tables.rising.data(), static_cast<size_t>(tessellation.segments), writer);
}

void write_quad(const shared::QuadPoints& c, uint32_t n, vec3* out) {
    const float step = static_cast<float>(n);
    for (uint32_t j = 1; j < n; ++j)
        for (uint32_t i = 1; i < n; ++i)
            *out++ = shared::quad_position(c, static_cast<float>(i) / step,
                                           static_cast<float>(j) / step);
}

/// Splits begin .. end where triangles change to quads or back.
void write_faces(const Topology& topology, const PatchControl& control,
                 const Tessellation& tessellation, const Tables& tables, size_t begin, size_t end,
                 vec3* positions) {
    const auto size = [&](size_t f) { return topology.face_size(static_cast<uint32_t>(f)); };
    while (begin < end) {
        size_t run = begin;
        while (run < end && size(run) == 3) ++run;
        if (run > begin)
            write_triangles(topology, control, tessellation, tables, begin, run, positions);
        for (; run < end && size(run) == 4; ++run)
            write_quad(quad_points(topology, control, static_cast<uint32_t>(run)),
                       static_cast<uint32_t>(tessellation.segments),
                       positions + tessellation.face_first[run]);
        begin = run;
    }
}

/// So many faces or edges make up about 64 KiB.
size_t grain(int64_t vertices_each) {
    return static_cast<size_t>(std::max<int64_t>(1, 5400 / std::max<int64_t>(vertices_each, 1)));
}

}  // namespace

void evaluate_uniform(const Topology& topology, const PatchControl& control,
                      const Tessellation& tessellation, std::span<vec3> positions) {
    const int64_t n = tessellation.segments;
    const Tables tables = tables_for(static_cast<size_t>(n));
    for (size_t v = 0; v < tessellation.vertex_half.size(); ++v) {
        const uint32_t h = tessellation.vertex_half[v];
        if (h != kNone)
            positions[v] = control.positions[topology.vertex[h]];
        else
            positions[v] = v < control.positions.size() ? control.positions[v] : vec3{0, 0, 0};
    }
    if (n == 1) return;
    parallel_for(tessellation.edge_half.size(), grain(n - 1), [&](size_t begin, size_t end) {
        write_edges(topology, control, tessellation, tables, begin, end, positions.data());
    });
    parallel_for(tessellation.face_segments.size(), grain((n - 1) * (n - 2) / 2),
                 [&](size_t begin, size_t end) {
                     write_faces(topology, control, tessellation, tables, begin, end,
                                 positions.data());
                 });
}

}  // namespace aglow::refine::cpu
