// SPDX-License-Identifier: Apache-2.0
// How a group walks over one tile of pairs: each subgroup takes a run of its own, row by row, and
// keeps a counter for each digit.
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/radix_sort.h"

layout(local_size_x_id = 0) in;  // kRadixRuns subgroups
layout(push_constant, scalar) uniform Push { RadixArgs args; };

shared uint counters[kRadixRuns][kRadixDigits];

uint digit_count() { return 1u << args.digit_bits; }
uint row_width() { return gl_WorkGroupSize.x / kRadixRuns; }
uint run_begin() { return group_index() * kRadixTile + gl_SubgroupID * kRadixRun; }

// Keys beyond the end hold the largest digit. They come last of all, so nothing is placed behind
// them.
uint load_key(uint i) { return i < args.count ? args.keys.at[i] : 0xffffffffu; }
uint digit_of(uint key) { return (key >> args.shift) & (digit_count() - 1u); }

// The lanes whose digit is the same as this one's.
// Source: Ashkiani, Davidson, Meyer & Owens, "GPU Multisplit", PPoPP 2016.
uvec4 lanes_with(uint digit) {
    uvec4 same = subgroupBallot(true);
    for (uint bit = 0u; bit < args.digit_bits; ++bit) {
        bool set = ((digit >> bit) & 1u) != 0u;
        uvec4 votes = subgroupBallot(set);
        same &= set ? votes : ~votes;
    }
    return same;
}

// Advances the subgroup's counter of each lane's digit, lower lanes first, and returns what it was.
uint advance_counter(uint digit) {
    uvec4 same = lanes_with(digit);
    uint before = subgroupBallotExclusiveBitCount(same);
    uint counter = counters[gl_SubgroupID][digit] + before;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    if (before + 1u == subgroupBallotBitCount(same)) counters[gl_SubgroupID][digit] = counter + 1u;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    return counter;
}

// Counts the digits in the subgroup's run.
void count_digits() {
    for (uint d = gl_SubgroupInvocationID; d < digit_count(); d += row_width())
        counters[gl_SubgroupID][d] = 0u;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    for (uint i = gl_SubgroupInvocationID; i < kRadixRun; i += row_width())
        atomicAdd(counters[gl_SubgroupID][digit_of(load_key(run_begin() + i))], 1u);
}
