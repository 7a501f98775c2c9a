// SPDX-License-Identifier: Apache-2.0
// Fits the boxes to the triangles, from the lowest nodes up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x_id = 0) in;  // climbing_group_size()
layout(push_constant, scalar) uniform Push { BvhRefitArgs args; };

layout(buffer_reference, buffer_reference_align = 4, scalar) coherent buffer CoherentBounds {
    Bounds at[];
};
CoherentBounds boxes = CoherentBounds(args.boxes);

Bounds leaf_box(BvhTrianglePtr triangles, uint first, uint mask) {
    Bounds box = empty_bounds();
    for (uint k = 0u; k < kBvhLeafSize; ++k) {
        if (((mask >> k) & 1u) == 0u) break;
        BvhTriangle t = triangles.at[first + k];
        if (t.absent != 0u) continue;
        box.lower = min(box.lower, min(t.a, min(t.b, t.c)));
        box.upper = max(box.upper, max(t.a, max(t.b, t.c)));
    }
    return box;
}

void refit(uint index) {
    BvhNode node = args.header.at[0].nodes.at[index];
    Bounds children[8];
    Bounds box = empty_bounds();
    uint child = node.child_base;
    uint triangle = node.triangle_base;
    for (uint s = 0u; s < 8u; ++s) {
        uint leaf = leaf_triangles(node.slots, s);
        children[s] = empty_bounds();
        if (is_node_slot(node.slots, s)) {
            children[s] = boxes.at[child];
            ++child;
        } else if (leaf != 0u) {
            children[s] = leaf_box(args.header.at[0].triangles, triangle, leaf);
            triangle += uint(bitCount(leaf));
        }
        box = united(box, children[s]);
    }
    node = gridded(node, box);
    for (uint s = 0u; s < 8u; ++s) node = with_child_box(node, s, children[s]);
    args.header.at[0].nodes.at[index] = node;
    boxes.at[index] = box;
    if (index == 0u) args.header.at[0].box = box;
}

void main() {
    uint index = global_index();
    if (index >= args.node_count) return;
    if (args.header.at[0].nodes.at[index].slots >> 24u != 0u) return;

    while (true) {
        refit(index);
        uint parent = args.parents.at[index];
        if (parent == kNoNode) break;
        memoryBarrierBuffer();
        uint children = uint(bitCount(args.header.at[0].nodes.at[parent].slots >> 24u));
        if (atomicAdd(args.arrivals.at[parent], 1u) + 1u < children) break;
        memoryBarrierBuffer();
        index = parent;
    }
}
