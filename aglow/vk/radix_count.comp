// SPDX-License-Identifier: Apache-2.0
// How many keys of each tile hold each digit, and how many of those each run finds before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/radix_sort.glsl"

void main() {
    for (uint d = gl_SubgroupInvocationID; d < digit_count(); d += row_width())
        counters[gl_SubgroupID][d] = 0u;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    for (uint row = gl_SubgroupInvocationID; row < kRadixRun; row += row_width())
        atomicAdd(counters[gl_SubgroupID][digit_of(load_key(run_begin() + row))], 1u);
    barrier();
    for (uint d = gl_LocalInvocationID.x; d < digit_count(); d += gl_WorkGroupSize.x) {
        uint count = 0u;
        for (uint run = 0u; run < kRadixRuns; ++run) {
            args.run_counts.at[run_index(run) * digit_count() + d] = count;
            count += counters[run][d];
        }
        args.tile_counts.at[d * args.tile_count + group_index()] = count;
    }
}
