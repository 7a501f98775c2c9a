// SPDX-License-Identifier: Apache-2.0
// Turns the minima of every segment into its box.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/segmented_bounds.h"

layout(local_size_x = kBoundsGroup) in;
layout(push_constant, scalar) uniform Push { SegmentedBoundsArgs args; };

vec3 decoded(uvec3 key) {
    return uintBitsToFloat(mix(~key, key & 0x7fffffffu, notEqual(key >> 31, uvec3(0u))));
}

void main() {
    uint segment = global_index();
    if (segment >= args.segment_count) return;
    Minima minima = args.minima.at[segment];
    args.bounds.at[segment] = Bounds(decoded(minima.lower), decoded(~minima.upper));
}
