// SPDX-License-Identifier: Apache-2.0
// to[i] = from[i]
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

layout(local_size_x = 256) in;
struct CopyArgs {
    uint first_group;
    uint count;
    uintPtr from;
    uintPtr to;
};
layout(push_constant, scalar) uniform Push { CopyArgs args; };

void main() {
    uint i = global_index();
    if (i < args.count) args.to.at[i] = args.from.at[i];
}
