// SPDX-License-Identifier: Apache-2.0
// Writes the wide nodes and says which triangles their leaves hold; bvh_move.comp copies them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_rows.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhEmitArgs args; };

uint triangle_of(uint leaf) { return args.binary.at[leaf].left; }

// Names the triangles of a leaf of the wide tree and returns their number. Without branches over
// memory, because the slots of neighbours are of all kinds.
uint emit_leaf(BvhTrianglePtr triangles, uint to, uint node) {
    bool is_one = node >= args.triangle_count;
    uvec2 top = children_of(args.binary, node);
    uvec2 leaves = is_one ? uvec2(node) : top;
    if (leaves.y < args.triangle_count) leaves = leaves.yx;  // of three, one child holds two
    bool is_three = leaves.x < args.triangle_count;
    uvec2 two = children_of(args.binary, leaves.x);
    uint first = is_three ? two.x : leaves.x;
    uint second = is_three ? two.y : leaves.y;
    triangles.at[to].triangle = triangle_of(first);
    if (!is_one) triangles.at[to + 1u].triangle = triangle_of(second);
    if (is_three) triangles.at[to + 2u].triangle = triangle_of(leaves.y);
    return is_one ? 1u : is_three ? 3u : 2u;
}

void store_node(uint index, BvhNode node) {
    BvhRowOut rows = BvhRowOut(args.header.at[0].nodes);
    rows.at[5u * index] = row_of(uvec4(floatBitsToUint(node.origin), node.exponents));
    rows.at[5u * index + 1u] = row_of(uvec4(node.child_base, node.triangle_base, node.slots, 0u));
    rows.at[5u * index + 2u] = row_of(uvec4(node.lower_x, node.upper_x));
    rows.at[5u * index + 3u] = row_of(uvec4(node.lower_y, node.upper_y));
    rows.at[5u * index + 4u] = row_of(uvec4(node.lower_z, node.upper_z));
}

void main() {
    uint i = global_index();
    if (i >= args.node_count) return;

    uint binary = args.list.at[i];
    bool is_root = binary == args.counters.at[0].root;
    uint index = is_root ? 0u : args.indices.at[binary];
    Bounds box = box_of(args.binary, binary);
    BvhTrianglePtr triangles = args.header.at[0].triangles;

    BvhNode node;
    node.child_base = args.children.at[i] + 1u;
    node.triangle_base = args.leaf_sizes.at[i];
    node.slots = 0u;
    node.unused = 0u;
    node = gridded(node, box);
    uint child = node.child_base;
    uint triangle = node.triangle_base;
    [[unroll]] for (uint s = 0u; s < 8u; ++s) {
        uint slot = args.slots.at[i].node[s];
        if (slot != kNoNode) {
            uint from = slot & ~kLeafSlot;
            node = with_child_box(node, s, box_of(args.binary, from));
            if (slot < kLeafSlot) {
                node.slots |= 1u << (24u + s);
                args.parents.at[child] = index;
                ++child;
            } else {
                uint count = emit_leaf(triangles, triangle, from);
                node.slots |= ((1u << count) - 1u) << (3u * s);
                triangle += count;
            }
        }
    }
    store_node(index, node);
    args.boxes.at[index] = box;
    if (is_root) {
        args.parents.at[0] = kNoNode;
        args.header.at[0].box = box;
    }
}
