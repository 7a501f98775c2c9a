// SPDX-License-Identifier: Apache-2.0
// values[i] = value + i
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

layout(local_size_x = 64) in;
struct IotaArgs {
    uint first_group;
    uint count;
    uintPtr values;
    uint value;
};
layout(push_constant, scalar) uniform Push { IotaArgs args; };

void main() {
    uint i = global_index();
    if (i < args.count) args.values.at[i] = args.value + i;
}
