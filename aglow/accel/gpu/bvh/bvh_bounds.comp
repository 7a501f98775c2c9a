// SPDX-License-Identifier: Apache-2.0
// Bounding box and number of the usable triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kBvhGroupSize) in;

// Each invocation takes several triangles, so that few atomic operations remain.
const uint kTrianglesPerInvocation = 16u;

void main() {
    Bounds box = empty_bounds();
    uint count = 0u;
    uint first = group_index() * kBvhGroupSize * kTrianglesPerInvocation + gl_LocalInvocationID.x;
    for (uint k = 0u; k < kTrianglesPerInvocation; ++k) {
        uint i = first + k * kBvhGroupSize;
        if (i >= args.triangle_count) break;
        Bounds triangle = triangle_bounds(args.triangles.at[i]);
        box = united(box, triangle);
        count += triangle.lower.x <= triangle.upper.x ? 1u : 0u;
    }

    vec3 lower = subgroupMin(box.lower);
    vec3 upper = subgroupMax(box.upper);
    count = subgroupAdd(count);
    if (!subgroupElect() || count == 0u) return;
    atomicMin(args.counters.at[0].lower.x, ordered_bits(lower.x));
    atomicMin(args.counters.at[0].lower.y, ordered_bits(lower.y));
    atomicMin(args.counters.at[0].lower.z, ordered_bits(lower.z));
    atomicMax(args.counters.at[0].upper.x, ordered_bits(upper.x));
    atomicMax(args.counters.at[0].upper.y, ordered_bits(upper.y));
    atomicMax(args.counters.at[0].upper.z, ordered_bits(upper.z));
    atomicAdd(args.counters.at[0].usable_count, count);
}
