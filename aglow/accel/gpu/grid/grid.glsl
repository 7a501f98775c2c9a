// SPDX-License-Identifier: Apache-2.0
// Rays through a uniform grid: see trace.glsl.
#ifndef AGLOW_ACCEL_GPU_GRID_GLSL
#define AGLOW_ACCEL_GPU_GRID_GLSL
#include "aglow/accel/gpu/grid/grid_walk.glsl"
#include "aglow/shared/grid.h"

// Tests the triangles of one cell, lowering walk.best. Returns whether the ray needs to go no
// further.
bool test_references(TrianglePtr triangles, uintPtr references, uint first, uint first_triangle,
                     bool any, inout GridWalk walk) {
    for (uint i = first;; ++i) {
        uint reference = references.at[i];
        uint triangle = reference & ~kLastReference;
        AG_COUNT_TRIANGLES;
        TriangleHit found =
            intersect_triangle(walk.sheared, triangles.at[triangle], walk.near, walk.best.t);
        triangle += first_triangle;
        if (found.hit != 0u && AG_ACCEPT_HIT(triangle, found.barycentrics, found.t + walk.offset)) {
            walk.best = RayHit(found.t, triangle, found.barycentrics);
            if (any) return true;
        }
        if ((reference & kLastReference) != 0u) return false;
    }
}

void trace_grid(uvec2 address, uint first_triangle, RayQuery query, bool any, inout RayHit hit) {
    GridHeader grid = GridHeaderPtr(address).at[0];
    GridWalk walk = enter_grid(grid.shape, query, hit);
    if (!walk.inside) return;
    uvec3 resolution = grid.shape.resolution;
    // Through empty cells first, so that the rays of a subgroup meet again at triangles.
    for (;;) {
        bool inside = true;
        uint word;
        for (;;) {
            AG_COUNT_STEPS;
            word = grid.cells.at[cell_index(walk.cell, resolution)];
            if ((word & kEmptyCell) == 0u) break;
            int skip = int(word & ~kEmptyCell);
            vec3 exits = block_exits(walk.ray, walk.cell, skip);
            float exit = min(min(exits.x, exits.y), exits.z);
            walk.cell = cell_behind(walk.ray, walk.cell, skip, exits, exit);
            inside = exit < walk.best.t && is_inside(walk.cell, resolution);
            if (!inside) break;
        }
        if (!inside ||
            test_references(grid.triangles, grid.references, word, first_triangle, any, walk)) {
            break;
        }
        vec3 exits = block_exits(walk.ray, walk.cell, 1);
        float exit = min(min(exits.x, exits.y), exits.z);
        walk.cell = next_cell(walk.ray, walk.cell, exits, exit);
        if (exit >= walk.best.t || !is_inside(walk.cell, resolution)) break;
    }
    leave_grid(walk, hit);
}
#endif
