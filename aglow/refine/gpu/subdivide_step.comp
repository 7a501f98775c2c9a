// SPDX-License-Identifier: Apache-2.0
// Points of one level of subdivision as sums of those before.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/subdivision.h"

layout(local_size_x = kSubdividePointGroup) in;
layout(push_constant, scalar) uniform Push { SubdivideStepArgs args; };

void main() {
    uint point = global_index();
    if (point >= args.count) return;
    vec3 sum = vec3(0.0f);
    for (uint t = args.begin.at[point]; t < args.begin.at[point + 1u]; ++t) {
        uint first = args.index.at[t] * args.from_width + args.from_channel;
        float weight = args.weight.at[t];
        sum.x += weight * args.from.at[first];
        if (args.channels > 1u) sum.y += weight * args.from.at[first + 1u];
        if (args.channels > 2u) sum.z += weight * args.from.at[first + 2u];
    }
    uint first = point * args.to_width + args.to_channel;
    args.to.at[first] = sum.x;
    if (args.channels > 1u) args.to.at[first + 1u] = sum.y;
    if (args.channels > 2u) args.to.at[first + 2u] = sum.z;
}
