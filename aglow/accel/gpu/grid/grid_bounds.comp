// SPDX-License-Identifier: Apache-2.0
// Copies triangles and finds the box of the usable ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { GridBoundsArgs args; };

// Unsigned integers in the order of the floats that they are made from.
uvec3 ordered_bits(vec3 v) {
    uvec3 bits = floatBitsToUint(v);
    return mix(bits | 0x80000000u, ~bits, greaterThanEqual(bits, uvec3(0x80000000u)));
}

void main() {
    vec3 lower = vec3(uintBitsToFloat(0x7f800000u));  // +infinity
    vec3 upper = -lower;
    uint first = group_index() * kGridGroupSize * kBoundsPerInvocation + gl_LocalInvocationID.x;
    for (uint k = 0u; k < kBoundsPerInvocation; ++k) {
        uint i = first + k * kGridGroupSize;
        if (i >= args.count) break;
        Triangle t = args.from.at[i];
        args.to.at[i] = t;
        if (is_usable_triangle(t)) {
            lower = min(min(lower, t.a), min(t.b, t.c));
            upper = max(max(upper, t.a), max(t.b, t.c));
        }
    }
    uvec3 low = ordered_bits(subgroupMin(lower));
    uvec3 high = ordered_bits(subgroupMax(upper));
    if (subgroupElect()) {
        atomicMin(args.work.at[0].lower.x, low.x);
        atomicMin(args.work.at[0].lower.y, low.y);
        atomicMin(args.work.at[0].lower.z, low.z);
        atomicMax(args.work.at[0].upper.x, high.x);
        atomicMax(args.work.at[0].upper.y, high.y);
        atomicMax(args.work.at[0].upper.z, high.z);
    }
}
