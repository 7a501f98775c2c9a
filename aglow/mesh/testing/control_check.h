// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/control_mesh.h"
#include "aglow/mesh/testing/topology_check.h"

/// What must hold of every control mesh, for tests.
namespace aglow::mesh::testing {

/// The first thing that is wrong, or nothing.
inline std::string find_control_fault(const Mesh& mesh, const ControlMesh& c) {
    const Topology &t = c.topology, &s = c.seams;
    if (std::string fault = find_topology_fault(t); !fault.empty()) return fault;
    if (std::string fault = find_topology_fault(s); !fault.empty()) return "seams: " + fault;
    if (c.positions.size() != t.vertex_count() || c.vertices.size() != t.vertex_count() ||
        c.corners.size() != t.half_edge_count() || c.face_primitive.size() != t.face_count() ||
        c.seam_vertices.size() != s.vertex_count() || c.seam_to_vertex.size() != s.vertex_count())
        return "arrays differ in size";
    if (s.face_begin != t.face_begin) return "seams have other faces";
    for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
        const VertexOf corner = c.corners[h];
        const Primitive& p = mesh.primitives[corner.primitive];
        if (p.positions[corner.vertex] != c.positions[t.vertex[h]]) return "a corner has moved";
        if (corner.primitive != c.face_primitive[t.face[h]]) return "a face changes primitives";
        if (c.seam_to_vertex[s.vertex[h]] != t.vertex[h]) return "seams have other corners";
        if (s.twin[h] != kNone && s.twin[h] != t.twin[h]) return "seams join other faces";
        const VertexOf seam = c.seam_vertices[s.vertex[h]];
        if (seam.primitive != corner.primitive) return "seams join primitives";
        for (const auto& set : p.texcoords)
            if (set[seam.vertex] != set[corner.vertex]) return "seams join texture coordinates";
        if (!p.colors.empty() && p.colors[seam.vertex] != p.colors[corner.vertex])
            return "seams join colours";
    }
    return "";
}

}  // namespace aglow::mesh::testing
