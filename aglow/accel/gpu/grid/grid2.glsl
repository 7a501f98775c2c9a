// SPDX-License-Identifier: Apache-2.0
// Rays through a two-level grid: see trace.glsl.
#ifndef AGLOW_ACCEL_GPU_GRID2_GLSL
#define AGLOW_ACCEL_GPU_GRID2_GLSL
#include "aglow/accel/gpu/grid/grid.glsl"
#include "aglow/shared/grid2.h"

// Walks the grid in one cell of the first level from t = `enter`. Returns whether the ray needs to
// go no further.
bool trace_leaves(Grid2Header grid, CellRay ray, ivec3 cell, uint first_leaf, uvec3 resolution,
                  float enter, ShearedRay sheared, float near, float offset, uint first_triangle,
                  bool any, inout RayHit hit) {
    vec3 leaves = vec3(resolution);
    vec3 corner = vec3(cell);
    ray.origin = (ray.origin - corner) * leaves;
    ray.direction *= leaves;
    ray.bias += corner * ray.inverse;
    ray.inverse /= leaves;
    ivec3 leaf = cell_at(ray, enter, ivec3(0), ivec3(resolution) - 1);
    do {
        AG_COUNT_STEPS;
        uint word = grid.leaf_cells.at[first_leaf + cell_index(leaf, resolution)];
        if ((word & kEmptyCell) == 0u &&
            test_references(grid.triangles, grid.references, word, sheared, near, offset,
                            first_triangle, any, hit)) {
            return true;
        }
        vec3 exits = block_exits(ray, leaf, 1);
        float exit = min(min(exits.x, exits.y), exits.z);
        if (exit >= hit.t) return true;
        leaf = next_cell(ray, leaf, exits, exit);
    } while (is_inside(leaf, resolution));
    return false;
}

void trace_grid2(uvec2 address, uint first_triangle, RayQuery query, bool any, inout RayHit hit) {
    Grid2Header grid = Grid2HeaderPtr(address).at[0];
    GridEntry entry = enter_grid(grid.shape, query, hit.t);
    if (!entry.inside) return;
    CellRay ray = entry.ray;
    RayHit best = RayHit(hit.t - entry.offset, kNoTriangle, vec2(0.0f));
    ShearedRay sheared = sheared_ray(entry.origin, query.direction);
    uvec3 resolution = grid.shape.resolution;
    ivec3 cell = cell_at(ray, entry.t, ivec3(0), ivec3(resolution) - 1);
    float enter = entry.t;
    do {
        AG_COUNT_STEPS;
        uint at = cell_index(cell, resolution);
        uint word = grid.cells.at[at];
        bool empty = (word & kEmptyCell) != 0u;
        if (!empty &&
            trace_leaves(grid, ray, cell, word, unpacked_resolution(grid.leaf_resolutions.at[at]),
                         enter, sheared, entry.near, entry.offset, first_triangle, any, best)) {
            break;
        }
        int skip = empty ? int(word & ~kEmptyCell) : 1;
        vec3 exits = block_exits(ray, cell, skip);
        enter = min(min(exits.x, exits.y), exits.z);
        if (enter >= best.t) break;
        cell = cell_behind(ray, cell, skip, exits, enter);
    } while (is_inside(cell, resolution));
    if (best.triangle == kNoTriangle) return;
    hit = best;
    hit.t += entry.offset;
}
#endif
