// SPDX-License-Identifier: Apache-2.0
// The control points of one face, gathered from those of a mesh.
#pragma once
#include "aglow/refine/patches.h"
#include "aglow/shared/pattern.h"
#include "aglow/shared/pn_quad.h"

namespace aglow::refine::cpu {

/// The points of the half-edge's edge, in the direction of the half-edge, which ends at `end`.
inline shared::EdgePoints points_along(const Topology& topology, const PatchControl& control,
                                       uint32_t h, uint32_t end) {
    const shared::EdgePoints e = control.edges[topology.edge[h]];
    if (topology.vertex[h] < end) return e;
    return {e.second, e.first};
}

/// The corners of a face, then the points of its edges: PatchPoints of 3, or QuadPoints of 4.
template <uint32_t kCorners, class Points>
Points outline_points(const Topology& topology, const PatchControl& control, uint32_t f) {
    Points c;
    const uint32_t first = topology.face_begin[f];
    for (uint32_t i = 0; i < kCorners; ++i) {
        const uint32_t end = topology.vertex[first + (i + 1) % kCorners];
        const shared::EdgePoints e = points_along(topology, control, first + i, end);
        c.p[i] = control.positions[topology.vertex[first + i]];
        c.p[kCorners + 2 * i] = e.first;
        c.p[kCorners + 2 * i + 1] = e.second;
    }
    return c;
}

inline shared::PatchPoints triangle_points(const Topology& topology, const PatchControl& control,
                                           uint32_t f) {
    auto c = outline_points<3, shared::PatchPoints>(topology, control, f);
    c.p[9] = control.centers[f];
    return c;
}

inline shared::QuadPoints quad_points(const Topology& topology, const PatchControl& control,
                                      uint32_t f) {
    return outline_points<4, shared::QuadPoints>(topology, control, f);
}

/// The normals of a face: Normals is PatchNormals or QuadNormals.
template <class Normals>
Normals face_normals(const Topology& topology, const PatchControl& control, uint32_t f) {
    Normals c;
    const uint32_t first = topology.face_begin[f], count = topology.face_size(f);
    for (uint32_t i = 0; i < count; ++i) {
        c.n[i] = control.normals[first + i];
        c.n[count + i] = control.middle_normals[first + i];
    }
    return c;
}

/// The directions in which displacement moves a face, likewise.
template <class Normals>
Normals face_directions(const Topology& topology, const PatchControl& control, uint32_t f) {
    Normals c;
    const uint32_t first = topology.face_begin[f], count = topology.face_size(f);
    for (uint32_t i = 0; i < count; ++i) {
        c.n[i] = control.directions[topology.vertex[first + i]];
        c.n[count + i] = control.middle_directions[topology.edge[first + i]];
    }
    return c;
}

/// Bit i: the i-th half-edge of the face runs from the vertex of the higher number.
inline uint32_t reversed_edges(const Topology& topology, uint32_t f) {
    uint32_t bits = 0;
    const uint32_t first = topology.face_begin[f];
    for (uint32_t i = 0; i < topology.face_size(f); ++i)
        if (topology.vertex[first + i] > topology.end(first + i)) bits |= 1u << i;
    return bits;
}

inline shared::PatchLevels levels_of(const Topology& topology, const Tessellation& tessellation,
                                     uint32_t f) {
    shared::PatchLevels levels = {
        {1, 1, 1, 1}, tessellation.face_inner[f], static_cast<uint32_t>(tessellation.levels)};
    const uint32_t first = topology.face_begin[f];
    for (uint32_t i = 0; i < topology.face_size(f); ++i)
        levels.edge[i] = tessellation.edge_level[tessellation.edge[first + i]];
    return levels;
}

}  // namespace aglow::refine::cpu
