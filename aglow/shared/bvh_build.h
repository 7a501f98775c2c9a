// SPDX-License-Identifier: Apache-2.0
// Building a binary tree of boxes over triangles: what its kernels share.
//
// Leaves are the triangles in the order of their Morton codes. The hierarchy that the codes imply
// (Apetrei, "Fast and Simple Agglomerative LBVH Construction", CGVC 2014) only says which stretches
// of leaves are clustered together: H-PLOC (Benthin, Meister, Barczak, Mehalwal, Tsakok & Kensler,
// "H-PLOC: Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
// Construction", HPG 2024) merges nearest neighbours in a stretch until few clusters remain, which
// go on into the stretch above.
#ifndef AGLOW_SHARED_BVH_BUILD_H
#define AGLOW_SHARED_BVH_BUILD_H
#include "aglow/shared/bvh.h"
#include "aglow/shared/bvh_collapse.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kBvhGroupSize = 64u;

// Clusters that leave a stretch for the one above; the merging kernel has two such at a time.
// With 1 the tree is that of the Morton codes themselves.
AG_CONST uint kMergeKeep = 16u;
AG_CONST uint kMergeCount = 32u;
// How many neighbours to either side are looked at. More make no better trees.
AG_CONST uint kMergeRadius = 4u;

// Nodes of the binary tree over n triangles: inner ones at 0 to n - 2, leaves at n and beyond.
struct BinaryNode {
    Bounds box;
    uint left;   // of a leaf: its triangle
    uint right;  // of a leaf: half_area() of its box, as a float
};
AG_BUFFER_OF(BinaryNode);

// Costs are found in waves: the first has the nodes over two leaves, each further one the nodes
// whose second child was in the one before. Few nodes are left for the last wave, which climbs from
// each of its nodes as far as it gets.
AG_CONST uint kCostWaves = 12u;

AG_CONST uint kNoNode = 0xffffffffu;
AG_CONST uint kRightChild = 0x80000000u;  // in a parent's index: the child is its right one

// A stretch of leaves first..last whose two parts, which meet between split and split + 1, are
// ready to be clustered.
struct Stretch {
    uint first, split, last;
};
AG_BUFFER_OF(Stretch);

// A node without parent, and the first leaf of those that came together in it: merging two makes
// node place(second) - 1, so every node has a number that depends on no order of work.
struct Cluster {
    uint node;
    uint place;
};
AG_BUFFER_OF(Cluster);

// What the kernels of one build tell each other and the host.
struct BvhCounters {
    uvec3 lower, upper;  // of the corners of usable triangles, as ordered_bits()
    uint usable_count;   // triangles in the tree
    uint stretch_count;
    uint root;                    // of the binary tree
    uint node_count;              // of the wide tree
    uint depth;                   // of the wide tree; an upper bound
    uint ready[kCostWaves + 1u];  // nodes in each wave of the cost kernel
};
AG_BUFFER_OF(BvhCounters);

// Arguments of all kernels that build. Arrays of [n] are as long as there are triangles.
struct BvhBuildArgs {
    uint first_group;
    uint triangle_count;
    uint merge_keep;   // kMergeKeep or 1
    uint cost_metric;  // kCost...
    uint wave;         // of the cost kernel
    uint stride;       // its invocations
    TrianglePtr triangles;
    BvhCountersPtr counters;
    uintPtr keys;             // [n] Morton codes
    uintPtr order;            // [n] triangles in the order of the codes
    BinaryNodePtr nodes;      // [2n]
    uintPtr parents;          // [2n]
    uintPtr arrivals;         // [n]
    StretchPtr stretches;     // [n / kMergeKeep + 1]
    ClusterPtr clusters;      // [n]
    CollapseCostPtr costs;    // [n]
    CollapseChoicePtr links;  // [n]
    uintPtr flags;            // [n] 1: node becomes a wide node; before, two halves for the nodes
                              // of this wave and of the next
};

// A float as an integer of the same order.
AG_FN uint ordered_bits(float v) {
    uint bits = float_bits(v);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

AG_FN float ordered_float(uint bits) {
    return bits_float((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

// Spreads the low 10 bits so that two zeros follow each.
AG_FN uint spread_bits(uint v) {
    uint x = v & 0x3ffu;
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    return (x | (x << 2u)) & 0x09249249u;
}

AG_CONST uint kMortonBits = 30u;
// Sorts triangles that are not part of the tree behind all others.
AG_CONST uint kUnusableKey = 0x40000000u;

// 30-bit Morton code of a point in a box, whose cells are cubes.
AG_FN uint morton_code(vec3 p, vec3 lower, float extent) {
    float scale = extent > 0.0f ? 1024.0f / extent : 0.0f;
    uint x = uint(clamp((p.x - lower.x) * scale, 0.0f, 1023.0f));
    uint y = uint(clamp((p.y - lower.y) * scale, 0.0f, 1023.0f));
    uint z = uint(clamp((p.z - lower.z) * scale, 0.0f, 1023.0f));
    return (spread_bits(x) << 2u) | (spread_bits(y) << 1u) | spread_bits(z);
}

// How far apart two neighbours in the order of keys are: the highest bit in which they differ.
// Equal keys differ in their place, so that a run of them becomes a balanced tree.
struct KeyDistance {
    uint key, place;
};

AG_FN KeyDistance key_distance(uint key, uint next_key, uint place) {
    KeyDistance d;
    d.key = key ^ next_key;
    d.place = place ^ (place + 1u);
    return d;
}

AG_FN bool is_nearer(KeyDistance a, KeyDistance b) {
    return a.key < b.key || (a.key == b.key && a.place < b.place);
}

// How good it is to merge clusters i and j of a group, lower is better: the surface of the box
// around both, of which the last bits give way to i ^ j. The same for (i, j) and (j, i) and never
// the same for (i, j) and (i, k): the best pair of all is always each other's best, and clusters
// that all coincide pair up by twos.
AG_FN uint merge_key(Bounds a, Bounds b, uint i, uint j) {
    return (float_bits(half_area(united(a, b))) & ~(kMergeCount - 1u)) | (i ^ j);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::BinaryNode) == 32);
static_assert(sizeof(aglow::shared::BvhBuildArgs) == 120);
#endif
#endif
