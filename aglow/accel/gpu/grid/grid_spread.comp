// SPDX-License-Identifier: Apache-2.0
// Spreads the set bits of cells by `step` along each axis: by all distances up to it where the set
// is made of cubes at least 2 step - 1 wide. One invocation makes the 32 cells of a word.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { GridSpreadArgs args; };

void main() {
    uint words = row_words(args.resolution.x);
    uvec3 size = uvec3(words, args.resolution.yz);
    uint i = global_index();
    uint row = i / words;
    ivec3 at = ivec3(i - row * words, row % size.y, row / size.y);
    if (at.z >= int(size.z)) return;

    uint left = 0u;
    uint middle = 0u;
    uint right = 0u;
    int step = int(args.step);
    for (int z = at.z - step; z <= at.z + step; z += step) {
        if (uint(z) >= size.z) continue;
        for (int y = at.y - step; y <= at.y + step; y += step) {
            if (uint(y) >= size.y) continue;
            uint word = (uint(z) * size.y + uint(y)) * words + uint(at.x);
            middle |= args.from.at[word];
            if (at.x > 0) left |= args.from.at[word - 1u];
            if (uint(at.x) + 1u < words) right |= args.from.at[word + 1u];
        }
    }
    uint up = (middle << step) | (left >> (32 - step));
    uint down = (middle >> step) | (right << (32 - step));
    args.to.at[i] = middle | up | down;
}
