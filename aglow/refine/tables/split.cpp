// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/split.h"

#include <algorithm>

namespace aglow::refine {
namespace {

/// Half-edges of the children, by those of their parents.
struct Children {
    const Topology& mesh;
    Scheme scheme;

    uint32_t in_face(uint32_t h) const { return h - mesh.face_begin[mesh.face[h]]; }
    /// The half-edge that starts h's child at its corner: along the first half of h.
    uint32_t first_half(uint32_t h) const {
        return scheme == Scheme::loop ? 12 * mesh.face[h] + 3 * in_face(h) : 4 * h;
    }
    /// Along the second half of h.
    uint32_t second_half(uint32_t h) const {
        return first_half(mesh.next(h)) + (scheme == Scheme::loop ? 2 : 3);
    }
};

void allocate(Topology& fine, uint32_t faces, uint32_t corners, uint32_t edges, uint32_t vertices) {
    const uint32_t half_edges = faces * corners;
    fine.face_begin.resize(size_t{faces} + 1);
    for (uint32_t f = 0; f <= faces; ++f) fine.face_begin[f] = f * corners;
    fine.vertex.resize(half_edges);
    fine.twin.resize(half_edges);
    fine.edge.resize(half_edges);
    fine.face.resize(half_edges);
    for (uint32_t h = 0; h < half_edges; ++h) fine.face[h] = h / corners;
    fine.edge_half.resize(edges);
    fine.edge_sharpness.assign(edges, 0.0f);
    fine.vertex_half.assign(vertices, kNone);
    fine.vertex_sharpness.assign(vertices, 0.0f);
}

/// What both schemes share: the halves of the edges, and the vertices there were.
void halve_edges(const Children& child, Topology& fine) {
    const Topology& mesh = child.mesh;
    const uint32_t vertex_count = mesh.vertex_count();
    for (uint32_t v = 0; v < vertex_count; ++v) {
        if (mesh.vertex_half[v] != kNone)
            fine.vertex_half[v] = child.first_half(mesh.vertex_half[v]);
        fine.vertex_sharpness[v] = child_sharpness(mesh.vertex_sharpness[v]);
    }
    for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
        const uint32_t h = mesh.edge_half[e];
        fine.edge_half[2 * e] = child.first_half(h);
        fine.edge_half[2 * e + 1] = child.second_half(h);
        fine.edge_sharpness[2 * e] = child_sharpness(mesh.edge_sharpness[e]);
        fine.edge_sharpness[2 * e + 1] = fine.edge_sharpness[2 * e];
        // The second half, since on a boundary it is from there that the fan is turned through.
        fine.vertex_half[vertex_count + e] = child.second_half(h);
    }
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
        const uint32_t a = child.first_half(h), b = child.second_half(h);
        const uint32_t e = mesh.edge[h], twin = mesh.twin[h];
        const bool along = mesh.edge_half[e] == h;
        fine.vertex[a] = mesh.vertex[h];
        fine.vertex[b] = vertex_count + e;
        fine.edge[a] = 2 * e + (along ? 0 : 1);
        fine.edge[b] = 2 * e + (along ? 1 : 0);
        fine.twin[a] = twin == kNone ? kNone : child.second_half(twin);
        fine.twin[b] = twin == kNone ? kNone : child.first_half(twin);
    }
}

void pair(Topology& fine, uint32_t edge, uint32_t g, uint32_t h) {
    fine.twin[g] = h;
    fine.twin[h] = g;
    fine.edge[g] = fine.edge[h] = edge;
    fine.edge_half[edge] = std::min(g, h);
}

/// Corner i's child: v_i, e_i, e_(i-1); that in the middle: e_0, e_1, e_2.
Topology split_triangles(const Topology& mesh) {
    Topology fine;
    const uint32_t faces = mesh.face_count();
    allocate(fine, 4 * faces, 3, 2 * mesh.edge_count() + 3 * faces,
             mesh.vertex_count() + mesh.edge_count());
    halve_edges({mesh, Scheme::loop}, fine);
    for (uint32_t f = 0; f < faces; ++f)
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t before = (i + 2) % 3;
            const uint32_t corner = 12 * f + 3 * i + 1, middle = 12 * f + 9 + before;
            fine.vertex[corner] = mesh.vertex_count() + mesh.edge[3 * f + i];
            fine.vertex[middle] = mesh.vertex_count() + mesh.edge[3 * f + before];
            pair(fine, 2 * mesh.edge_count() + 3 * f + i, corner, middle);
        }
    return fine;
}

/// Corner h's child: its vertex, that of its edge, that of the face, that of the edge before.
Topology split_polygons(const Topology& mesh) {
    Topology fine;
    const uint32_t corners = mesh.half_edge_count(), edges = mesh.edge_count();
    allocate(fine, corners, 4, 2 * edges + corners,
             mesh.vertex_count() + edges + mesh.face_count());
    halve_edges({mesh, Scheme::catmull_clark}, fine);
    for (uint32_t h = 0; h < corners; ++h) {
        const uint32_t centre = mesh.vertex_count() + edges + mesh.face[h];
        fine.vertex[4 * h + 1] = mesh.vertex_count() + mesh.edge[h];
        fine.vertex[4 * h + 2] = centre;
        fine.vertex_half[centre] = std::min(fine.vertex_half[centre], 4 * h + 2);
        pair(fine, 2 * edges + h, 4 * h + 1, 4 * mesh.next(h) + 2);
    }
    return fine;
}

}  // namespace

Topology split(const Topology& mesh, Scheme scheme) {
    return scheme == Scheme::loop ? split_triangles(mesh) : split_polygons(mesh);
}

}  // namespace aglow::refine
