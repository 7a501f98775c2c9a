// SPDX-License-Identifier: Apache-2.0
// Least costs of the binary nodes, from the leaves up: of two children, the last to arrive goes on
// with their parent.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x_id = 0) in;  // climbing_group_size()

CollapseCost cost_of(uint node) {
    CollapseCost cost;
    if (node < args.triangle_count) {
        cost = CoherentCosts(args.costs).at[node];
    } else {
        cost = leaf_cost(half_area(args.nodes.at[node].box), args.cost_metric);
    }
    return cost;
}

void main() {
    uint leaf = global_index();
    if (leaf >= args.counters.at[0].usable_count) return;

    uint root = args.counters.at[0].root;
    uint node = args.triangle_count + leaf;
    bool climbs = node != root;
    while (climbs) {
        uint parent = args.parents.at[node] & ~kRightChild;
        memoryBarrierBuffer();
        climbs = atomicAdd(args.arrivals.at[parent], 1u) != 0u;
        memoryBarrierBuffer();
        if (climbs) {
            BinaryNode made = args.nodes.at[parent];
            CollapseResult result =
                collapsed(cost_of(made.left), cost_of(made.right), half_area(made.box),
                          parent == root, args.cost_metric);
            CoherentCosts(args.costs).at[parent] = result.cost;
            args.links.at[parent] = result.choice;
            if (parent == root) args.counters.at[0].depth = result.cost.summary & 255u;
            node = parent;
            climbs = node != root;
        }
    }
}
