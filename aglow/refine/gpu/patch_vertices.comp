// SPDX-License-Identifier: Apache-2.0
// Gathers where the vertices of a coarse mesh are in a frame, and along which direction
// displacement moves them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/device_patch.h"

layout(local_size_x = kPatchGroup) in;
layout(push_constant, scalar) uniform Push { PatchControlArgs args; };

void main() {
    uint vertex = global_index();
    PatchMesh mesh = args.mesh.at[0];
    if (vertex >= mesh.vertex_count) return;
    mesh.positions.at[vertex] = args.positions.at[mesh.vertex_source.at[vertex]];

    uint begin = mesh.fan_begin.at[vertex];
    uint end = mesh.fan_begin.at[vertex + 1u];
    vec3 sum = vec3(0.0f);
    for (uint i = begin; i < end; ++i)
        sum += args.normals.at[mesh.corner_normal.at[mesh.fans.at[i]]];
    mesh.directions.at[vertex] = unit_or(sum, sum);
}
