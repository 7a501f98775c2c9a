// SPDX-License-Identifier: Apache-2.0
// Writing the nodes of a wide tree once it is known which they are, and moving its boxes with the
// triangles.
#ifndef AGLOW_SHARED_BVH_EMIT_H
#define AGLOW_SHARED_BVH_EMIT_H
#include "aglow/shared/bvh_build.h"
AG_NAMESPACE_BEGIN

// The binary nodes in the slots of a wide node. kNoNode: an empty slot; with kLeafSlot: a leaf of
// the wide tree.
struct SlotNodes {
    uint node[8];
};
AG_BUFFER_OF(SlotNodes);

AG_CONST uint kLeafSlot = 0x80000000u;

// Wide nodes are numbered twice: `list` has them in the order of their binary nodes, which fixes
// where their children lie; the tree itself has the children of each side by side.
struct BvhEmitArgs {
    uint first_group;
    uint triangle_count;
    uint node_count;  // of the wide tree
    uint pad;
    TrianglePtr triangles;
    BvhCountersPtr counters;
    BinaryNodePtr binary;
    CollapseChoicePtr links;
    uintPtr list;         // [node_count] binary nodes that become wide ones
    SlotNodesPtr slots;   // [node_count] in the order of the list
    uintPtr children;     // [node_count] children that are nodes; then their exclusive sums
    uintPtr leaf_sizes;   // [node_count] triangles in leaves; then their exclusive sums
    uintPtr indices;      // [triangle_count] of binary nodes in the wide tree
    BvhHeaderPtr header;  // its addresses are set
    BoundsPtr boxes;      // [node_count] of the wide nodes, exact
    uintPtr parents;      // [node_count] of the wide nodes; kNoNode for the root
};

// Refitting: nodes without nodes below them come first, and whoever brings the last child of a
// node goes on with it.
struct BvhRefitArgs {
    uint first_group;
    uint triangle_count;
    uint node_count;
    uint pad;
    TrianglePtr triangles;
    BvhHeaderPtr header;
    BoundsPtr boxes;
    uintPtr parents;
    uintPtr arrivals;  // [node_count] children that are done; 0 before
};

// How well a child lies in a slot, seen from the middle of its parent: slot bits 0, 1 and 2 stand
// for the upper half in x, y and z.
AG_FN float slot_fit(vec3 offset, uint slot) {
    return ((slot & 1u) != 0u ? offset.x : -offset.x) + ((slot & 2u) != 0u ? offset.y : -offset.y) +
           ((slot & 4u) != 0u ? offset.z : -offset.z);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::BvhEmitArgs) == 112);
static_assert(sizeof(aglow::shared::BvhRefitArgs) == 56);
#endif
#endif
