// SPDX-License-Identifier: Apache-2.0
// Moves each pair to its place: behind those of smaller digits, those of the same digit in earlier
// tiles, in earlier runs of its tile, and in its own run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/radix_sort.glsl"

void main() {
    uint run = run_index(gl_SubgroupID);
    for (uint d = gl_SubgroupInvocationID; d < digit_count(); d += row_width())
        counters[gl_SubgroupID][d] = args.tile_counts.at[d * args.tile_count + group_index()] +
                                     args.run_counts.at[run * digit_count() + d];
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    for (uint row = gl_SubgroupInvocationID; row < kRadixRun; row += row_width()) {
        uint i = run_begin() + row;
        uint key = load_key(i);
        uint value = i < args.count ? args.values.at[i] : 0u;
        uint place = advance_counter(digit_of(key));
        if (i < args.count) {
            args.sorted_keys.at[place] = key;
            args.sorted_values.at[place] = value;
        }
    }
}
