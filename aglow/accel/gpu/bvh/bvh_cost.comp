// SPDX-License-Identifier: Apache-2.0
// Least costs of the binary nodes of one wave, from the leaves up. Of two children, the last to be
// done makes their parent part of the next wave; in the last wave it goes on with their parent.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x_id = 0) in;                 // climbing_group_size() in the last wave
layout(constant_id = 1) const uint kLast = 0u;  // 1: in the last wave

CollapseCost cost_of(uint node) {
    bool is_leaf = node >= args.triangle_count;
    CoherentRows rows = CoherentRows(args.costs);
    u64vec2 low = rows.at[is_leaf ? 0u : 2u * node];
    u64vec2 high = rows.at[is_leaf ? 1u : 2u * node + 1u];
    uvec4 a = row_words(low);
    uvec4 b = row_words(high);
    CollapseCost cost;
    cost.cost = float[7](uintBitsToFloat(a.x), uintBitsToFloat(a.y), uintBitsToFloat(a.z),
                         uintBitsToFloat(a.w), uintBitsToFloat(b.x), uintBitsToFloat(b.y),
                         uintBitsToFloat(b.z));
    cost.summary = b.w;
    CollapseCost leaf =
        leaf_cost(uintBitsToFloat(args.nodes.at[is_leaf ? node : 0u].right), args.cost_metric);
    [[unroll]] for (int i = 0; i < 7; ++i) cost.cost[i] = is_leaf ? leaf.cost[i] : cost.cost[i];
    cost.summary = is_leaf ? leaf.summary : cost.summary;
    return cost;
}

void find_cost(uint node, bool is_root) {
    uvec2 children = children_of(args.nodes, node);
    CollapseResult result =
        collapsed(cost_of(children.x), cost_of(children.y), half_area(box_of(args.nodes, node)),
                  is_root, args.cost_metric);
    float c[7] = result.cost.cost;
    CoherentRows rows = CoherentRows(args.costs);
    rows.at[2u * node] = row_of(floatBitsToUint(vec4(c[0], c[1], c[2], c[3])));
    rows.at[2u * node + 1u] =
        row_of(uvec4(floatBitsToUint(vec3(c[4], c[5], c[6])), result.cost.summary));
    args.links.at[node] = result.choice;
    if (is_root) args.counters.at[0].depth = result.cost.summary & 255u;
}

// Counts the node as done; whether its parent is the next to do.
bool arrive(uint parent) {
    memoryBarrierBuffer();
    bool is_next = atomicAdd(args.arrivals.at[parent], 1u) == 1u;
    memoryBarrierBuffer();
    return is_next;
}

void main() {
    uint count = args.counters.at[0].ready[args.wave];
    uint root = args.counters.at[0].root;
    for (uint i = global_index(); i < count; i += args.stride) {
        uint node = ready_nodes(args.wave).at[i];
        bool is_next = true;
        while (is_next) {
            bool is_root = node == root;
            find_cost(node, is_root);
            node = args.parents.at[node] & ~kRightChild;
            is_next = false;
            if (!is_root) is_next = arrive(node);
            if (kLast == 0u) break;
        }
        if (kLast == 0u) append(is_next, node, args.wave + 1u);
    }
}
