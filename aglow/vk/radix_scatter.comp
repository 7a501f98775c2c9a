// SPDX-License-Identifier: Apache-2.0
// Moves each pair to its place: behind those of smaller digits, those of the same digit in earlier
// tiles, and those of the same digit before it in its own tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/radix_sort.glsl"

void main() {
    count_digits();
    barrier();
    for (uint d = gl_LocalInvocationID.x; d < digit_count(); d += gl_WorkGroupSize.x) {
        uint place = args.counts.at[d * args.tile_count + group_index()];
        for (uint run = 0u; run < kRadixRuns; ++run) {
            uint count = counters[run][d];
            counters[run][d] = place;
            place += count;
        }
    }
    barrier();
    for (uint row = gl_SubgroupInvocationID; row < kRadixRun; row += row_width()) {
        uint i = run_begin() + row;
        uint key = load_key(i);
        uint place = advance_counter(digit_of(key));
        if (i < args.count) {
            args.sorted_keys.at[place] = key;
            args.sorted_values.at[place] = args.values.at[i];
        }
    }
}
