// SPDX-License-Identifier: Apache-2.0
// Gathers the control points and normals of faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/device_patch.h"

layout(local_size_x = kPatchGroup) in;
layout(push_constant, scalar) uniform Push { PatchControlArgs args; };

vec3 flat_normal(vec3 p[12], uint corners) {
    vec3 n = corners == 4u ? cross(p[2] - p[0], p[3] - p[1]) : cross(p[1] - p[0], p[2] - p[0]);
    return unit_or(n, n);
}

void gather_points(PatchMesh mesh, PatchFace face, inout DevicePatch result) {
    vec3 corner_sum = vec3(0.0f);
    vec3 edge_sum = vec3(0.0f);
    for (uint i = 0u; i < face.corners; ++i) {
        EdgePoints e = mesh.edge_points.at[face.edge[i]];
        bool reversed = ((face.reversed >> i) & 1u) != 0u;
        result.p[i] = mesh.positions.at[face.vertex[i]];
        result.p[face.corners + 2u * i] = reversed ? e.second : e.first;
        result.p[face.corners + 2u * i + 1u] = reversed ? e.first : e.second;
        corner_sum += result.p[i];
        edge_sum += e.first + e.second;
    }
    if (face.corners == 3u) result.p[9] = patch_center(corner_sum, edge_sum);
}

void gather_normals(PatchMesh mesh, PatchFace face, inout DevicePatch result) {
    for (uint i = 0u; i < face.corners; ++i) {
        result.n[i] = args.normals.at[mesh.corner_normal.at[face.first + i]];
        if (mesh.tagged == 1u)
            result.n[i] = tagged_normal(result.n[i], flat_normal(result.p, face.corners),
                                        bounded_tags(mesh.tags.at[face.vertex[i]]).sharpness);
    }
    uint quadratic = mesh.kinds.at[face.kind].quadratic;
    for (uint i = 0u; i < face.corners; ++i) {
        uint next = i + 1u == face.corners ? 0u : i + 1u;
        result.n[face.corners + i] =
            quadratic == 1u
                ? quadratic_middle(result.p[next] - result.p[i], result.n[i], result.n[next])
                : linear_middle(result.n[i], result.n[next]);
    }
}

void main() {
    uint index = global_index();
    PatchMesh mesh = args.mesh.at[0];
    if (index >= mesh.face_count) return;
    PatchFace face = mesh.faces.at[index];
    DevicePatch result;
    for (int i = 0; i < 12; ++i) result.p[i] = vec3(0.0f);
    for (int i = 0; i < 8; ++i) result.n[i] = vec3(0.0f);
    gather_points(mesh, face, result);
    gather_normals(mesh, face, result);
    mesh.patches.at[index] = result;
    if (mesh.displacement_kind == kNoDisplacement) return;
    for (uint i = 0u; i < face.corners; ++i) {
        mesh.patch_directions.at[index].n[i] = mesh.directions.at[face.vertex[i]];
        mesh.patch_directions.at[index].n[face.corners + i] = mesh.edge_directions.at[face.edge[i]];
    }
}
