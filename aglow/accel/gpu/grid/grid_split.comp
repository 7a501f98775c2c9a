// SPDX-License-Identifier: Apache-2.0
// How many work items each job needs besides its first one: see kColumnsPerItem.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/accel/gpu/grid/grid_sums.glsl"
#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(push_constant, scalar) uniform Push { GridPairsArgs args; };
#include "aglow/accel/gpu/grid/grid_jobs.glsl"

void main() {
    uint i = global_index();
    uint extra = 0u;
    if (i < args.job_count) {
        Job j = job(i);
        if (j.usable) extra = (max(column_count(j.triangle), 1u) - 1u) / kColumnsPerItem;
        args.extras.at[i] = extra;
    }
    AG_ADD_TO_SUM(args.work.at[0].extras, extra);
}
