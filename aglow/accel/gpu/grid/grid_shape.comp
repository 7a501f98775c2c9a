// SPDX-License-Identifier: Apache-2.0
// Chooses the grid's resolution from the bounds of its triangles; one invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid_build.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { GridShapeArgs args; };

vec3 from_ordered_bits(uvec3 bits) {
    return uintBitsToFloat(
        mix(~bits, bits & 0x7fffffffu, greaterThanEqual(bits, uvec3(0x80000000u))));
}

void main() {
    GridWork work = args.work.at[0];
    Bounds bounds;
    bounds.lower = from_ordered_bits(work.lower);
    bounds.upper = from_ordered_bits(work.upper);
    work.shape.lower = vec3(0.0f);
    work.shape.cells_per_length = vec3(0.0f);
    work.shape.resolution = uvec3(0u);
    if (bounds.lower.x <= bounds.upper.x) work.shape = grid_shape(bounds, args.cells);
    args.work.at[0].shape = work.shape;
}
