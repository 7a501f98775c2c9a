// SPDX-License-Identifier: Apache-2.0
// Vertices that got no normal of their own take that of their first triangle that has one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/mesh/gpu/triangle_normal.glsl"
#include "aglow/shared/pose.h"

layout(local_size_x = kPoseGroup) in;
layout(push_constant, scalar) uniform Push { PoseArgs args; };

void repair_normal(uint vertex) {
    if (args.normals.at[vertex] != vec3(0.0f)) return;
    uint triangle = args.first_triangle.at[vertex];
    if (triangle == kNoTriangle) return;
    args.normals.at[vertex] = triangle_normal(args.corners.at[triangle]);
}

void main() {
    // A loop that is rarely entered, and no branch: llvmpipe runs through both sides of branches.
    for (uint repairs = args.without_normal.at[0]; repairs != 0u; repairs = 0u)
        for (uint i = 0u; i < kChunksPerRepairGroup; ++i) {
            uint index = group_index() * kChunksPerRepairGroup + i;
            if (index >= args.chunk_count) break;
            PoseChunk chunk = args.chunks.at[index];
            PosePart part = args.parts.at[chunk.part];
            uint vertex = chunk.first + gl_LocalInvocationID.x;
            if (vertex < part.vertex_count) repair_normal(part.first_vertex + vertex);
        }
}
