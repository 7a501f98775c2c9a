// SPDX-License-Identifier: Apache-2.0
// Copies triangles that moved to their places in the tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhRefitArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.triangle_count) return;

    BvhTrianglePtr triangles = args.header.at[0].triangles;
    Triangle moved = args.triangles.at[triangles.at[i].triangle];
    bool usable = usable_triangle(moved);
    triangles.at[i].absent = usable ? 0u : 1u;
    if (!usable) {
        moved.a = vec3(0.0f);
        moved.b = moved.a;
        moved.c = moved.a;
    }
    triangles.at[i].a = moved.a;
    triangles.at[i].b = moved.b;
    triangles.at[i].c = moved.c;
}
