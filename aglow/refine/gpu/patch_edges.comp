// SPDX-License-Identifier: Apache-2.0
// Control points of edges, each computed once: what both of its faces take.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/device_patch.h"
#include "aglow/shared/phong_tessellation.h"

layout(local_size_x = kPatchGroup) in;
layout(push_constant, scalar) uniform Push { PatchControlArgs args; };

ShapeTags tags_of(PatchMesh mesh, uint vertex) { return bounded_tags(mesh.tags.at[vertex]); }

EdgePoints points_of(PatchMesh mesh, PatchEdgeEnds ends, PatchEdge e, uint shape) {
    if (shape == kFlatPatch) return phong_edge_points(e, 0.0f);
    if (shape == kPhongPatch) return phong_edge_points(e, mesh.phong_shape);
    if (mesh.tagged == 0u) return pn_edge_points(e);
    return tagged_edge_points(e, tags_of(mesh, ends.low), tags_of(mesh, ends.high));
}

void main() {
    uint edge = global_index();
    PatchMesh mesh = args.mesh.at[0];
    if (edge >= mesh.edge_count) return;
    PatchEdgeEnds ends = mesh.edges.at[edge];
    PatchEdge e;
    e.a = mesh.positions.at[ends.low];
    e.b = mesh.positions.at[ends.high];
    e.left_a = args.normals.at[ends.left_low];
    e.left_b = args.normals.at[ends.left_high];
    e.right_a = args.normals.at[ends.right_low];
    e.right_b = args.normals.at[ends.right_high];
    PatchKind kind = mesh.kinds.at[mesh.vertex_kind.at[ends.low]];
    mesh.edge_points.at[edge] = points_of(mesh, ends, e, kind.shape);
    vec3 at_low = mesh.directions.at[ends.low];
    vec3 at_high = mesh.directions.at[ends.high];
    mesh.edge_directions.at[edge] = kind.quadratic == 1u
                                        ? quadratic_middle(e.b - e.a, at_low, at_high)
                                        : linear_middle(at_low, at_high);
}
