// SPDX-License-Identifier: Apache-2.0
// Turns the triangles of a chunk the right way round and gathers their corners.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/mesh/gpu/triangle_normal.glsl"
#include "aglow/shared/pose.h"

layout(local_size_x = kPoseGroup) in;
layout(push_constant, scalar) uniform Push { PoseArgs args; };

// A vertex without normal takes its first triangle's that has one.
void offer_normal(uint vertex, uint triangle) {
    if (args.normals.at[vertex] == vec3(0.0f))
        atomicMin(args.first_triangle.at[vertex], triangle);
}

void main() {
    PoseChunk chunk = args.chunks.at[group_index()];
    PosePart part = args.parts.at[chunk.part];
    uint triangle = chunk.first + gl_LocalInvocationID.x;
    if (triangle >= part.triangle_count) return;

    uvec3 vertices = part.triangles.at[triangle];
    uint mirrored = args.states.at[chunk.part].mirrored;
    if (part.influences > 0u) mirrored = args.mirrored.at[part.first_mirrored + vertices.x];
    if (mirrored == 1u) vertices = vertices.xzy;
    vertices += part.first_vertex;
    uint place = part.first_triangle + triangle;
    Triangle corners;
    corners.a = args.positions.at[vertices.x];
    corners.b = args.positions.at[vertices.y];
    corners.c = args.positions.at[vertices.z];
    args.indices.at[place] = vertices;
    args.corners.at[place] = corners;

    // A loop that is rarely entered, and no branch: llvmpipe runs through both sides of branches.
    for (uint repairs = args.without_normal.at[0]; repairs != 0u; repairs = 0u) {
        if (triangle_normal(corners) == vec3(0.0f)) break;
        offer_normal(vertices.x, place);
        offer_normal(vertices.y, place);
        offer_normal(vertices.z, place);
    }
}
