// SPDX-License-Identifier: Apache-2.0
// Writes the wide nodes and copies the triangles of their leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhEmitArgs args; };

void emit_triangle(uint to, uint leaf) {
    uint triangle = args.binary.at[leaf].left;
    Triangle corners = args.triangles.at[triangle];
    BvhTriangle copy;
    copy.a = corners.a;
    copy.b = corners.b;
    copy.c = corners.c;
    copy.triangle = triangle;
    copy.absent = 0u;
    copy.unused = 0u;
    args.header.at[0].triangles.at[to] = copy;
}

// Copies the triangles of a leaf of the wide tree and returns their number.
uint emit_leaf(uint to, uint node) {
    if (node >= args.triangle_count) {
        emit_triangle(to, node);
        return 1u;
    }
    BinaryNode pair = args.binary.at[node];
    uint single = pair.left;
    uint other = pair.right;
    uint count = 0u;
    if (other < args.triangle_count) {  // of three, one child holds two
        single = pair.right;
        other = pair.left;
    }
    if (single < args.triangle_count) {
        BinaryNode two = args.binary.at[single];
        emit_triangle(to, two.left);
        single = two.right;
        count = 1u;
    }
    emit_triangle(to + count, single);
    emit_triangle(to + count + 1u, other);
    return count + 2u;
}

void main() {
    uint i = global_index();
    if (i >= args.node_count) return;

    uint binary = args.list.at[i];
    bool is_root = binary == args.counters.at[0].root;
    uint index = is_root ? 0u : args.indices.at[binary];
    Bounds box = args.binary.at[binary].box;
    SlotNodes slots = args.slots.at[i];

    BvhNode node;
    node.child_base = args.children.at[i] + 1u;
    node.triangle_base = args.leaf_sizes.at[i];
    node.slots = 0u;
    node.unused = 0u;
    node = gridded(node, box);
    uint child = node.child_base;
    uint triangle = 0u;
    for (uint s = 0u; s < 8u; ++s) {
        uint slot = slots.node[s];
        if (slot == kNoNode) continue;
        uint from = slot & ~kLeafSlot;
        node = with_child_box(node, s, args.binary.at[from].box);
        if (slot < kLeafSlot) {
            node.slots |= 1u << (24u + s);
            args.parents.at[child] = index;
            ++child;
        } else {
            uint count = emit_leaf(node.triangle_base + triangle, from);
            node.slots |= ((1u << count) - 1u) << (3u * s);
            triangle += count;
        }
    }
    args.header.at[0].nodes.at[index] = node;
    args.boxes.at[index] = box;
    if (!is_root) return;
    args.parents.at[0] = kNoNode;
    args.header.at[0].box = box;
}
