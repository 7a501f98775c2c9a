// SPDX-License-Identifier: Apache-2.0
// The children of each wide node, in its slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_rows.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhEmitArgs args; };

uint found[8];
uint share[8];
uint found_count = 0u;

// The binary nodes that stand for a wide node's children: its own two, and in place of each that
// has a share of more than one, that one's.
void find_children(uint node) {
    found[0] = node;
    share[0] = node < args.triangle_count ? 8u : 1u;  // the only triangle there is stays itself
    found_count = 1u;
    uint k = 0u;
    while (k < found_count) {
        if (share[k] == 1u) {
            ++k;
            continue;
        }
        uvec2 pair = children_of(args.binary, found[k]);
        CollapseChoice choice = args.links.at[found[k]];
        uint s = share[k] == 8u ? 1u : share[k];
        found[k] = pair.x;
        share[k] = share_of(choice.left, s);
        found[found_count] = pair.y;
        share[found_count] = share_of(choice.right, s);
        ++found_count;
    }
}

uint leaf_size(uint node) {
    if (node >= args.triangle_count) return 1u;
    uvec2 pair = children_of(args.binary, node);
    return min(pair.x, pair.y) >= args.triangle_count ? 2u : 3u;
}

void main() {
    uint i = global_index();
    if (i >= args.node_count) return;

    uint node = args.list.at[i];
    find_children(node);
    Bounds box = box_of(args.binary, node);
    vec3 middle = box.lower * 0.5f + box.upper * 0.5f;

    SlotNodes slots;
    for (uint s = 0u; s < 8u; ++s) slots.node[s] = kNoNode;
    uint free = 255u;
    uint node_children = 0u;
    uint triangles = 0u;
    for (uint k = 0u; k < found_count; ++k) {
        uint child = found[k];
        Bounds child_box = box_of(args.binary, child);
        vec3 offset = child_box.lower * 0.5f + child_box.upper * 0.5f - middle;
        uint best = 0u;
        float best_fit = 0.0f;
        [[unroll]] for (uint s = 0u; s < 8u; ++s) {
            float fit = slot_fit(offset, s);
            bool is_free = ((free >> s) & 1u) != 0u;
            bool is_better = is_free && (((free >> best) & 1u) == 0u || fit > best_fit);
            best = is_better ? s : best;
            best_fit = is_better ? fit : best_fit;
        }
        free &= ~(1u << best);

        bool is_leaf = child >= args.triangle_count;
        if (!is_leaf) is_leaf = share_of(args.links.at[child].left, 1u) == 0u;
        slots.node[best] = is_leaf ? child | kLeafSlot : child;
        if (is_leaf) {
            triangles += leaf_size(child);
        } else {
            ++node_children;
        }
    }
    args.slots.at[i] = slots;
    args.children.at[i] = node_children;
    args.leaf_sizes.at[i] = triangles;
}
