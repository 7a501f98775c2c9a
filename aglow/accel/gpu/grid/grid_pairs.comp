// SPDX-License-Identifier: Apache-2.0
// Pairs of a cell and a triangle that overlaps it: counts them, then writes them in order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/accel/gpu/grid/grid_sums.glsl"
#include "aglow/shared/grid_build.h"

layout(local_size_x = kGridGroupSize) in;
layout(constant_id = 0) const uint kWrite = 0u;  // 0: count
layout(push_constant, scalar) uniform Push { GridPairsArgs args; };
#include "aglow/accel/gpu/grid/grid_jobs.glsl"

uint first_cell;
uint index;
uint begin = 0u;

void visit(uint cell, uint before) {
    if (kWrite == 0u) return;
    args.keys.at[begin + before] = first_cell + cell;
    args.values.at[begin + before] = index;
}
#define AG_VISIT_CELL(cell, before) visit(cell, before)
#include "aglow/accel/gpu/grid/grid_overlap.glsl"

// Pairs of chunk `chunk` of the columns of job `i`.
uint make_pairs(uint i, uint chunk) {
    Job j = job(i);
    if (!j.usable) return 0u;
    first_cell = j.first_cell;
    index = j.index;
    return visit_cells(j.triangle, chunk, j.resolution);
}

void main() {
    uint item = global_index();
    uint found = 0u;
    if (item < args.item_count) {
        if (kWrite != 0u) begin = args.counts.at[item];
        if (item < args.job_count) {
            found = make_pairs(item, 0u);
        } else {
            uint extra = item - args.job_count;
            uvec2 extras = args.work.at[0].extras;
            if (extra < extras.x + (extras.y << 12u)) {
                uint owner = item_owner(args.extras, args.job_count, extra);
                found = make_pairs(owner, 1u + extra - args.extras.at[owner]);
            }
        }
        if (kWrite == 0u) args.counts.at[item] = found;
    }
    if (kWrite == 0u) AG_ADD_TO_SUM(args.work.at[0].pairs, found);
}
