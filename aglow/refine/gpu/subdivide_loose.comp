// SPDX-License-Identifier: Apache-2.0
// Vertices that stay where they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/subdivision.h"

layout(local_size_x = kSubdividePointGroup) in;
layout(push_constant, scalar) uniform Push { SubdivideLooseArgs args; };

void main() {
    if (global_index() >= args.count) return;
    uint first = args.vertices.at[global_index()] * args.width;
    for (uint i = first; i < first + args.width; ++i)
        args.to.at[i] = args.zero == 1u ? 0.0f : args.from.at[i];
}
