// SPDX-License-Identifier: Apache-2.0
// Writes into empty cells how far it is to the next occupied one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { GridSkipArgs args; };

void main() {
    uint cell = global_index();
    uint rows = args.resolution.y * args.resolution.z;
    if (cell >= args.resolution.x * rows) return;
    uint words = row_words(args.resolution.x);
    uint x = cell % args.resolution.x;
    uint word = cell / args.resolution.x * words + x / 32u;
    uint bit = 1u << (x % 32u);
    if ((args.occupied.at[word] & bit) != 0u) return;
    uint distance = 1u;
    for (uint level = 0u; level < args.levels; ++level) {
        word += words * rows;
        if ((args.occupied.at[word] & bit) != 0u) break;
        distance = (1u << level) + 1u;
    }
    args.cells.at[cell] = kEmptyCell | distance;
}
