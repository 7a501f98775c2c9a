// SPDX-License-Identifier: Apache-2.0
// Points that lie elsewhere, one after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

struct GatherArgs {
    uint first_group;
    uint count;
    vec3Ptr from;
    uintPtr source;  // [count]
    vec3Ptr to;      // [count]
};
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { GatherArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    args.to.at[i] = args.from.at[args.source.at[i]];
}
