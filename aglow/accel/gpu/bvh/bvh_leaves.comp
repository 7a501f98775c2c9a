// SPDX-License-Identifier: Apache-2.0
// Leaves of the binary tree, and the lowest stretches of them that have to be clustered.
//
// Every leaf climbs the hierarchy of the keys; where two stretches meet, the first to arrive stops
// and the second goes on with both, up to the first stretch of more than `merge_keep` leaves.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kBvhGroupSize) in;

void main() {
    uint leaf = global_index();
    uint count = args.counters.at[0].usable_count;
    if (leaf >= count) return;

    uint triangle = args.order.at[leaf];
    BinaryNode node;
    node.box = triangle_bounds(args.triangles.at[triangle]);
    node.left = triangle;
    node.right = floatBitsToUint(half_area(node.box));
    args.nodes.at[args.triangle_count + leaf] = node;
    if (count == 1u) args.counters.at[0].root = args.triangle_count;

    uint first = leaf;
    uint last = leaf;
    while (last - first + 1u < count) {
        uint split = joint(first, last, count);
        uint other = atomicExchange(args.arrivals.at[split], split == last ? first : last);
        if (other == kNoNode) break;
        if (split == last) {
            last = other;
        } else {
            first = other;
        }
        uint size = last - first + 1u;
        if (size <= args.merge_keep && size < count) continue;
        Stretch stretch;
        stretch.first = first;
        stretch.split = split;
        stretch.last = last;
        args.stretches.at[atomicAdd(args.counters.at[0].stretch_count, 1u)] = stretch;
        break;
    }
}
