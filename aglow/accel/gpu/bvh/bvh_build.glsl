// SPDX-License-Identifier: Apache-2.0
// What the kernels that build a binary tree have in common.
#include "aglow/shared/bvh_build.h"

layout(push_constant, scalar) uniform Push { BvhBuildArgs args; };

// Views for what one invocation writes and another reads within the same dispatch.
layout(buffer_reference, buffer_reference_align = 4, scalar) coherent buffer CoherentNodes {
    BinaryNode at[];
};
layout(buffer_reference, buffer_reference_align = 4, scalar) coherent buffer CoherentClusters {
    Cluster at[];
};
layout(buffer_reference, buffer_reference_align = 4, scalar) coherent buffer CoherentCosts {
    CollapseCost at[];
};

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
