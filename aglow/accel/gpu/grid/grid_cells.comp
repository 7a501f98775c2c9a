// SPDX-License-Identifier: Apache-2.0
// Where the references of each occupied cell begin and end, from pairs in order of cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(constant_id = 0) const uint kLevel = kGridOneLevel;
layout(push_constant, scalar) uniform Push { GridCellsArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint cell = args.keys.at[i];
    bool last = i + 1u == args.count || args.keys.at[i + 1u] != cell;
    if (kLevel != kGridFirstLevel) {
        args.references.at[i] = args.values.at[i] | (last ? kLastReference : 0u);
    } else if (last) {
        args.ends.at[cell] = i + 1u;
    }
    if (i > 0u && args.keys.at[i - 1u] == cell) return;
    args.cells.at[cell] = i;
    if (kLevel == kGridSecondLevel) return;
    uint x = cell % args.resolution.x;
    uint row = cell / args.resolution.x;
    atomicOr(args.occupied.at[row * row_words(args.resolution.x) + x / 32u], 1u << (x % 32u));
}
