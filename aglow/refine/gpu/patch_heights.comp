// SPDX-License-Identifier: Apache-2.0
// Heights of vertices: the mean of what their height map has for the faces round them.
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
    Displacement d = mesh.kinds.at[mesh.vertex_kind.at[vertex]].displacement;
    uint begin = mesh.fan_begin.at[vertex];
    uint end = mesh.fan_begin.at[vertex + 1u];
    if (d.kind != kHeightMapDisplacement || begin == end) return;
    float mip = mesh.vertex_mips.at[vertex];
    float heights = 0.0f;
    for (uint i = begin; i < end; ++i)
        heights += map_height(mesh, d, mesh.uvs.at[mesh.fans.at[i]], mip);
    mesh.vertex_heights.at[vertex] = heights / float(end - begin);
}
