// SPDX-License-Identifier: Apache-2.0
// How many keys of each tile hold each digit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/radix_sort.glsl"

void main() {
    count_digits();
    barrier();
    for (uint d = gl_LocalInvocationID.x; d < digit_count(); d += gl_WorkGroupSize.x) {
        uint count = 0u;
        for (uint run = 0u; run < kRadixRuns; ++run) count += counters[run][d];
        args.counts.at[d * args.tile_count + group_index()] = count;
    }
}
