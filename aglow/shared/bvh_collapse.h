// SPDX-License-Identifier: Apache-2.0
// Which nodes of a binary tree become the nodes and leaves of the wide one.
//
// Source: Ylitie, Karras & Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", HPG 2017, section 3.1. For every node and i < 8 the least cost of representing what
// is below it by at most i wide nodes and leaves follows from those of its two children. The choice
// of least cost at the root is then handed down: a node is told how many it may be represented by
// (its share), and hands shares on to its children.
#ifndef AGLOW_SHARED_BVH_COLLAPSE_H
#define AGLOW_SHARED_BVH_COLLAPSE_H
#include "aglow/shared/bvh.h"
// Loops of a fixed count over small arrays, which are registers only where they are unrolled.
#ifdef __cplusplus
#define AG_UNROLL
#else
#extension GL_EXT_control_flow_attributes : require
#define AG_UNROLL [[unroll]]
#endif
AG_NAMESPACE_BEGIN

// What is made least: the expected time of a ray, or the depth of the wide tree. The least depth is
// at most a third of the binary tree's, rounded up, because three levels of two make one of eight.
AG_CONST uint kCostTime = 0u;
AG_CONST uint kCostDepth = 1u;

// Time of a triangle test where visiting a node takes 1.
AG_CONST float kTriangleCost = 0.3f;

// Of one binary node.
struct CollapseCost {
    float cost[7];  // [i - 1] with at most i nodes and leaves
    uint summary;   // depth if it becomes a node | depth if not << 8 | min(triangles, 4) << 16
};
AG_BUFFER_OF(CollapseCost);

// Three bits for each share s, at 3 s: the share of that child where the node has share s. With
// share 1 a node becomes a wide node, or a leaf, whose children have share 0.
struct CollapseChoice {
    uint left, right;
};
AG_BUFFER_OF(CollapseChoice);

struct CollapseResult {
    CollapseCost cost;
    CollapseChoice choice;
};

AG_FN CollapseCost leaf_cost(float area, uint metric) {
    CollapseCost r;
    AG_UNROLL for (int i = 0; i < 7; ++i) r.cost[i] =
        metric == kCostTime ? area * kTriangleCost : 0.0f;
    r.summary = 1u << 16u;
    return r;
}

// Bits of the shares that cost less than the next smaller one: others are never needed.
AG_FN uint needed_shares(CollapseCost c) {
    uint needed = 2u;
    AG_UNROLL for (int i = 1; i < 7; ++i) {
        if (c.cost[i] < c.cost[i - 1]) needed = needed | (2u << uint(i));
    }
    return needed;
}

#ifdef __cplusplus
inline uint highest_bit(uint v) { return static_cast<uint>(std::bit_width(v)) - 1u; }
#else
uint highest_bit(uint v) { return uint(findMSB(v)); }
#endif

// The largest needed share up to `share`.
AG_FN uint needed_share(uint needed, uint share) {
    return highest_bit(needed & ((2u << share) - 1u));
}

// Depth of what a child adds below its parent where it has that share.
AG_FN uint depth_with_share(uint summary, uint share) {
    return share == 1u ? summary & 255u : (summary >> 8u) & 255u;
}

AG_FN CollapseResult collapsed(CollapseCost left, CollapseCost right, float area, bool is_root,
                               uint metric) {
    // Least cost of 2 to 8 nodes and leaves, and how many of them the left child takes.
    float split_cost[9];
    uint split[9];
    AG_UNROLL for (int i = 2; i <= 8; ++i) {
        split_cost[i] = 0.0f;
        split[i] = 1u;
        AG_UNROLL for (int k = 1; k < i; ++k) {
            float l = left.cost[k - 1];
            float r = right.cost[i - k - 1];
            float cost = metric == kCostTime ? l + r : max(l, r);
            if (k == 1 || cost < split_cost[i]) {
                split_cost[i] = cost;
                split[i] = uint(k);
            }
        }
    }

    CollapseResult result;
    uint count = min((left.summary >> 16u) + (right.summary >> 16u), 4u);
    float as_node = metric == kCostTime ? area + split_cost[8] : 1.0f + split_cost[8];
    float as_leaf = metric == kCostTime ? area * kTriangleCost * float(count) : 0.0f;
    bool is_leaf = count <= kBvhLeafSize && as_leaf <= as_node && !is_root;
    result.cost.cost[0] = is_leaf ? as_leaf : as_node;
    AG_UNROLL for (int i = 1; i < 7; ++i) {
        float fewer = result.cost.cost[i - 1];
        float split_up = split_cost[i + 1];
        result.cost.cost[i] = split_up < fewer ? split_up : fewer;
    }

    uint needed_left = needed_shares(left);
    uint needed_right = needed_shares(right);
    uint depth_as_node = 0u;
    uint depth_if_split = 0u;
    result.choice.left = 0u;
    result.choice.right = 0u;
    AG_UNROLL for (uint s = 1u; s < 8u; ++s) {
        uint total = s == 1u ? 8u : s;
        uint share_left = needed_share(needed_left, split[total]);
        uint share_right = needed_share(needed_right, total - split[total]);
        uint depth = max(depth_with_share(left.summary, share_left),
                         depth_with_share(right.summary, share_right));
        if (s == 1u) {
            depth_as_node = is_leaf ? 0u : min(depth + 1u, 255u);
        } else {
            depth_if_split = max(depth_if_split, depth);
        }
        if (s > 1u || !is_leaf) {
            result.choice.left = result.choice.left | (share_left << (3u * s));
            result.choice.right = result.choice.right | (share_right << (3u * s));
        }
    }
    result.cost.summary = depth_as_node | (depth_if_split << 8u) | (count << 16u);
    return result;
}

// Shares of a descendant for each share of an ancestor, three bits each at 3 s. `shares` is the
// map from the node's share; `choice` maps the parent's share to the node's.
AG_CONST uint kSameShares = 0xfac688u;  // every share to itself
AG_FN uint shares_above(uint shares, uint choice) {
    uint r = 0u;
    AG_UNROLL for (uint s = 1u; s < 8u; ++s) {
        uint share = (choice >> (3u * s)) & 7u;
        r = r | (((shares >> (3u * share)) & 7u) << (3u * s));
    }
    return r;
}

AG_FN uint share_of(uint shares, uint s) { return (shares >> (3u * s)) & 7u; }

// Whether the share of the descendant is the same whatever that of the ancestor.
AG_FN bool is_decided(uint shares) { return shares == share_of(shares, 1u) * 0x249248u; }

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::CollapseCost) == 32);
#endif
#endif
