// SPDX-License-Identifier: Apache-2.0
// Which binary nodes have two leaves, and so make up the first wave of the cost kernel. Leaves count
// as children that are done.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kBvhGroupSize) in;

void main() {
    uint node = global_index();
    bool is_node = node + 1u < args.counters.at[0].usable_count;
    uvec2 children = children_of(args.nodes, is_node ? node : 0u);
    uint leaves = (children.x >= args.triangle_count ? 1u : 0u) +
                  (children.y >= args.triangle_count ? 1u : 0u);
    if (is_node) args.arrivals.at[node] = leaves;
    append(is_node && leaves == 2u, node, 0u);
}
