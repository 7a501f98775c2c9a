// SPDX-License-Identifier: Apache-2.0
// Copies triangles to their places in the tree, which name them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_rows.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhRefitArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.triangle_count) return;

    BvhTrianglePtr triangles = args.header.at[0].triangles;
    uint triangle = triangles.at[i].triangle;
    Triangle moved = args.triangles.at[triangle];
    bool usable = usable_triangle(moved);
    if (!usable) {
        moved.a = vec3(0.0f);
        moved.b = moved.a;
        moved.c = moved.a;
    }
    BvhRowOut rows = BvhRowOut(triangles);
    rows.at[3u * i] = row_of(floatBitsToUint(vec4(moved.a, moved.b.x)));
    rows.at[3u * i + 1u] = row_of(floatBitsToUint(vec4(moved.b.yz, moved.c.xy)));
    rows.at[3u * i + 2u] = row_of(uvec4(floatBitsToUint(moved.c.z), triangle, usable ? 0u : 1u, 0u));
}
