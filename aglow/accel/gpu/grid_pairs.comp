// SPDX-License-Identifier: Apache-2.0
// Pairs of a cell and a triangle that overlaps it: counts them, then writes them in order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/grid_build.h"
#include "aglow/accel/gpu/grid_sums.glsl"

layout(local_size_x = kGridGroupSize) in;
layout(constant_id = 0) const uint kWrite = 0u;  // 0: count
layout(push_constant, scalar) uniform Push { GridPairsArgs args; };

uint triangle = 0u;
uint begin = 0u;

void visit(uint cell, uint before) {
    if (kWrite == 0u) return;
    args.keys.at[begin + before] = cell;
    args.values.at[begin + before] = triangle;
}
#define AG_VISIT_CELL(cell, before) visit(cell, before)
#include "aglow/accel/gpu/grid_overlap.glsl"

void main() {
    uint item = global_index();
    uint found = 0u;
    if (item < args.item_count) {
        if (kWrite != 0u) begin = args.counts.at[item];
        triangle = item;
        uint chunk = 0u;
        bool busy = true;
        if (item >= args.triangle_count) {
            uint extra = item - args.triangle_count;
            uvec2 extras = args.work.at[0].extras;
            busy = extra < extras.x + (extras.y << 12u);
            if (busy) {
                triangle = item_owner(args.extras, args.triangle_count, extra);
                chunk = 1u + extra - args.extras.at[triangle];
            }
        }
        if (busy) {
            GridShape shape = args.work.at[0].shape;
            Triangle t = args.triangles.at[triangle];
            if (is_usable_triangle(t)) {
                found = visit_cells(grid_triangle(shape, t), chunk, shape.resolution);
            }
        }
        if (kWrite == 0u) args.counts.at[item] = found;
    }
    if (kWrite == 0u) AG_ADD_TO_SUM(args.work.at[0].pairs, found);
}
