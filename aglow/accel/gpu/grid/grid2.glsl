// SPDX-License-Identifier: Apache-2.0
// Rays through a two-level grid: see trace.glsl.
#ifndef AGLOW_ACCEL_GPU_GRID2_GLSL
#define AGLOW_ACCEL_GPU_GRID2_GLSL
#include "aglow/accel/gpu/grid/grid.glsl"
#include "aglow/shared/grid2.h"

// Walks the grid in the walk's cell of the first level. Returns whether the ray needs to go no
// further.
bool trace_leaves(Grid2Header grid, uint first_leaf, uvec3 resolution, uint first_triangle,
                  bool any, inout GridWalk walk) {
    vec3 leaves = vec3(resolution);
    vec3 corner = vec3(walk.cell);
    CellRay ray = walk.ray;
    ray.origin = (ray.origin - corner) * leaves;
    ray.direction *= leaves;
    ray.bias += corner * ray.inverse;
    ray.inverse /= leaves;
    ivec3 leaf = cell_at(ray, walk.enter, ivec3(0), ivec3(resolution) - 1);
    do {
        AG_COUNT_STEPS;
        uint word = grid.leaf_cells.at[first_leaf + cell_index(leaf, resolution)];
        if ((word & kEmptyCell) == 0u &&
            test_references(grid.triangles, grid.references, word, first_triangle, any, walk)) {
            return true;
        }
        vec3 exits = block_exits(ray, leaf, 1);
        float exit = min(min(exits.x, exits.y), exits.z);
        if (exit >= walk.best.t) return true;
        leaf = next_cell(ray, leaf, exits, exit);
    } while (is_inside(leaf, resolution));
    return false;
}

void trace_grid2(uvec2 address, uint first_triangle, RayQuery query, bool any, inout RayHit hit) {
    Grid2Header grid = Grid2HeaderPtr(address).at[0];
    GridWalk walk = enter_grid(grid.shape, query, hit);
    if (!walk.inside) return;
    uvec3 resolution = grid.shape.resolution;
    do {
        AG_COUNT_STEPS;
        uint at = cell_index(walk.cell, resolution);
        uint word = grid.cells.at[at];
        bool empty = (word & kEmptyCell) != 0u;
        if (!empty &&
            trace_leaves(grid, word, unpacked_resolution(grid.leaf_resolutions.at[at]),
                         first_triangle, any, walk)) {
            break;
        }
        int skip = empty ? int(word & ~kEmptyCell) : 1;
        vec3 exits = block_exits(walk.ray, walk.cell, skip);
        walk.enter = min(min(exits.x, exits.y), exits.z);
        if (walk.enter >= walk.best.t) break;
        walk.cell = cell_behind(walk.ray, walk.cell, skip, exits, walk.enter);
    } while (is_inside(walk.cell, resolution));
    leave_grid(walk, hit);
}
#endif
