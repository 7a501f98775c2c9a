// SPDX-License-Identifier: Apache-2.0
// Numbers the wide nodes: the children of each side by side.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/bvh_emit.h"

layout(local_size_x = kBvhGroupSize) in;
layout(push_constant, scalar) uniform Push { BvhEmitArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.node_count) return;

    SlotNodes slots = args.slots.at[i];
    uint next = args.children.at[i] + 1u;  // the root is node 0
    for (uint s = 0u; s < 8u; ++s) {
        if (slots.node[s] >= kLeafSlot) continue;
        args.indices.at[slots.node[s]] = next;
        ++next;
    }
}
