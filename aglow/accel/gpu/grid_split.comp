// SPDX-License-Identifier: Apache-2.0
// How many work items each triangle needs besides its first one: see kColumnsPerItem.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/grid_build.h"
#include "aglow/accel/gpu/grid_sums.glsl"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { GridSplitArgs args; };

void main() {
    uint i = global_index();
    uint extra = 0u;
    if (i < args.count) {
        Triangle t = args.triangles.at[i];
        if (is_usable_triangle(t)) {
            uint columns = column_count(grid_triangle(args.work.at[0].shape, t));
            extra = (columns - 1u) / kColumnsPerItem;
        }
        args.extras.at[i] = extra;
    }
    AG_ADD_TO_SUM(args.work.at[0].extras, extra);
}
