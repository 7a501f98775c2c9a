// SPDX-License-Identifier: Apache-2.0
// What the kernels that build a binary tree have in common.
#include "aglow/accel/gpu/bvh/bvh_rows.glsl"
#include "aglow/shared/bvh_build.h"

layout(push_constant, scalar) uniform Push { BvhBuildArgs args; };

// Views for what one invocation writes and another reads within the same dispatch.
layout(buffer_reference, buffer_reference_align = 8, scalar) coherent buffer CoherentWords {
    uint64_t at[];
};
layout(buffer_reference, buffer_reference_align = 16, scalar) coherent buffer CoherentRows {
    u64vec2 at[];
};

// The nodes of a wave of the cost kernel: half of the room for this one and half for the next.
uintPtr ready_nodes(uint wave) {
    return uintPtr(uint64_t(args.flags) + ((wave & 1u) != 0u ? 4u * uint64_t(args.triangle_count / 2u) : 0u));
}

// Adds the nodes of those invocations for which `is_ready` to a wave.
void append(bool is_ready, uint node, uint wave) {
    uvec4 ballot = subgroupBallot(is_ready);
    uint first = 0u;
    if (subgroupElect())
        first = atomicAdd(args.counters.at[0].ready[wave], subgroupBallotBitCount(ballot));
    first = subgroupBroadcastFirst(first);
    if (is_ready) ready_nodes(wave).at[first + subgroupBallotExclusiveBitCount(ballot)] = node;
}

// How far apart leaves i and i + 1 are.
KeyDistance leaf_distance(uint i) { return key_distance(args.keys.at[i], args.keys.at[i + 1u], i); }

// The leaf at whose end the stretch first..last, not yet all, meets the one it is joined with:
// `last`, or the leaf before `first`.
uint joint(uint first, uint last, uint count) {
    bool at_end = first == 0u;
    if (!at_end && last < count - 1u)
        at_end = is_nearer(leaf_distance(last), leaf_distance(first - 1u));
    return at_end ? last : first - 1u;
}
