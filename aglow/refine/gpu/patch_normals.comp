// SPDX-License-Identifier: Apache-2.0
// Normals of flat, displaced faces at their corners: the mean of all faces there, but for creases.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/displacement.h"

const uint kPatchDisplacement = kMixedDisplacement;
const uint kPatchCorners = 0u;
#include "aglow/refine/gpu/patch_surface.glsl"

layout(local_size_x = kPatchGroup) in;
layout(push_constant, scalar) uniform Push { PatchControlArgs args; };

void main() {
    uint vertex = global_index();
    PatchMesh mesh = args.mesh.at[0];
    if (vertex >= mesh.vertex_count) return;
    PatchKind kind = mesh.kinds.at[mesh.vertex_kind.at[vertex]];
    if (kind.displacement.kind != kHeightMapDisplacement || kind.shape != kFlatPatch) return;
    uint begin = mesh.fan_begin.at[vertex];
    uint end = mesh.fan_begin.at[vertex + 1u];
    for (uint i = begin; i < end; ++i) {
        uint half_edge = mesh.fans.at[i];
        uint own = mesh.face_of.at[half_edge];
        uint own_corner = half_edge - mesh.faces.at[own].first;
        vec3 sum = vec3(0.0f);
        for (uint k = begin; k < end; ++k) {
            uint other = mesh.face_of.at[mesh.fans.at[k]];
            PatchFace face = mesh.faces.at[other];
            uint corner = mesh.fans.at[k] - face.first;
            if (k == i || same_normal(mesh, own, own_corner, other, corner))
                sum += raised_flat_normal(mesh, other, face, corner_place(corner, face.corners),
                                          mesh.vertex_heights.at[vertex]);
        }
        mesh.raised_normals.at[half_edge] = unit_or(sum, mesh.patches.at[own].n[own_corner]);
    }
}
