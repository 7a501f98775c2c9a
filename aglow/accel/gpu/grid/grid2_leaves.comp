// SPDX-License-Identifier: Apache-2.0
// The resolution of the grid in each cell of the first level.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/grid2.h"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { Grid2LeavesArgs args; };

void main() {
    uint cell = global_index();
    if (cell >= args.count) return;
    uint end = args.ends.at[cell];
    uint leaves = 0u;
    if (end != 0u) {
        float triangles = float(end - args.begins.at[cell]);
        uvec3 r = leaf_resolution(args.work.at[0].shape, args.per_triangle * triangles);
        args.leaf_resolutions.at[cell] = packed_resolution(r);
        leaves = r.x * r.y * r.z;
    }
    args.leaf_counts.at[cell] = leaves;
}
