// SPDX-License-Identifier: Apache-2.0
// Gives every segment the box of nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/segmented_bounds.h"

layout(local_size_x = kBoundsGroup) in;
layout(push_constant, scalar) uniform Push { SegmentedBoundsArgs args; };

void main() {
    uint segment = global_index();
    if (segment < args.segment_count)
        args.minima.at[segment] = Minima(uvec3(kNoMinimum), uvec3(kNoMinimum));
}
