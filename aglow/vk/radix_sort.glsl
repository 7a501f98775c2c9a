// SPDX-License-Identifier: Apache-2.0
// How a group walks over one tile of pairs: each subgroup takes a run of its own, row by row, and
// keeps a counter for each digit. Both shaders of the sort see a tile in the same way.
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/radix_sort.h"

layout(local_size_x_id = 0) in;  // kRadixRuns subgroups
layout(push_constant, scalar) uniform Push { RadixArgs args; };

shared uint counters[kRadixRuns][kRadixDigits];

uint digit_count() { return 1u << args.digit_bits; }
uint row_width() { return gl_WorkGroupSize.x / kRadixRuns; }
uint run_index(uint run) { return group_index() * kRadixRuns + run; }
uint run_begin() { return group_index() * kRadixTile + gl_SubgroupID * kRadixRun; }

// Keys beyond the end hold the largest digit. They come last of all, so nothing is placed behind
// them.
uint load_key(uint i) { return i < args.count ? args.keys.at[i] : 0xffffffffu; }
uint digit_of(uint key) { return (key >> args.shift) & (digit_count() - 1u); }

// Of the lanes whose digit is the same as this one's: how many there are, and how many come before.
struct Peers {
    uint count, before;
};

// Asks lane after lane: the fastest with few of them, as software devices have.
Peers find_peers_by_lane(uint digit) {
    Peers peers = Peers(0u, 0u);
    for (uint lane = 0u; lane < row_width(); ++lane) {
        uint same = subgroupBroadcast(digit, lane) == digit ? 1u : 0u;
        peers.count += same;
        peers.before += lane < gl_SubgroupInvocationID ? same : 0u;
    }
    return peers;
}

// Asks all lanes bit after bit.
// Source: Ashkiani, Davidson, Meyer & Owens, "GPU Multisplit", PPoPP 2016.
Peers find_peers_by_bit(uint digit) {
    uvec4 same = subgroupBallot(true);
    for (uint bit = 0u; bit < args.digit_bits; ++bit) {
        bool set = ((digit >> bit) & 1u) != 0u;
        uvec4 votes = subgroupBallot(set);
        same &= set ? votes : ~votes;
    }
    return Peers(subgroupBallotBitCount(same), subgroupBallotExclusiveBitCount(same));
}

Peers find_peers(uint digit) {
    if (row_width() <= 8u) return find_peers_by_lane(digit);
    return find_peers_by_bit(digit);
}

// Advances the subgroup's counter of each lane's digit, lower lanes first, and returns what it was.
uint advance_counter(uint digit) {
    Peers peers = find_peers(digit);
    uint counter = counters[gl_SubgroupID][digit] + peers.before;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    if (peers.before + 1u == peers.count) counters[gl_SubgroupID][digit] = counter + 1u;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    return counter;
}
