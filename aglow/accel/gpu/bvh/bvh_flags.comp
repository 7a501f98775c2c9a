// SPDX-License-Identifier: Apache-2.0
// Which binary nodes become wide ones: hands the root's share down the path to each. Climbing from
// the node needs no order among invocations; it ends where the share is the same whatever those above are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kBvhGroupSize) in;

void main() {
    uint node = global_index();
    if (node >= args.triangle_count) return;

    bool is_node = node + 1u < args.counters.at[0].usable_count;
    // A node whose children have no share where it has share 1 becomes a leaf at most.
    if (is_node) is_node = share_of(args.links.at[node].left, 1u) != 0u;

    uint shares = kSameShares;
    uint root = args.counters.at[0].root;
    uint ancestor = node;
    while (is_node && ancestor != root && !is_decided(shares)) {
        uint parent = args.parents.at[ancestor];
        ancestor = parent & ~kRightChild;
        CollapseChoice choice = args.links.at[ancestor];
        shares = shares_above(shares, parent == ancestor ? choice.left : choice.right);
    }
    args.flags.at[node] = is_node && share_of(shares, 1u) == 1u ? 1u : 0u;
}
