// SPDX-License-Identifier: Apache-2.0
// Copies words from an address, as tests know no buffer of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

layout(local_size_x = 64) in;
struct GridReadArgs {
    uint first_group;
    uint count;
    uintPtr from, to;
};
layout(push_constant, scalar) uniform Push { GridReadArgs args; };

void main() {
    uint i = global_index();
    if (i < args.count) args.to.at[i] = args.from.at[i];
}
