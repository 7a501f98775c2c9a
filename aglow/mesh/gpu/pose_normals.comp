// SPDX-License-Identifier: Apache-2.0
// Vertices that got no normal of their own take that of their first triangle that has one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/mesh/gpu/triangle_normal.glsl"
#include "aglow/shared/pose.h"

layout(local_size_x = kPoseGroup) in;
layout(push_constant, scalar) uniform Push { PoseArgs args; };

void main() {
    if (args.without_normal.at[0] == 0u) return;
    PoseChunk chunk = args.chunks.at[group_index()];
    PosePart part = args.parts.at[chunk.part];
    uint vertex = chunk.first + gl_LocalInvocationID.x;
    if (vertex >= part.vertex_count) return;
    uint place = part.first_vertex + vertex;
    if (args.normals.at[place] != vec3(0.0f)) return;
    uint triangle = args.first_triangle.at[place];
    if (triangle != kNoTriangle) args.normals.at[place] = triangle_normal(args.corners.at[triangle]);
}
