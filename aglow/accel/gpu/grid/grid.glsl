// SPDX-License-Identifier: Apache-2.0
// Rays through a uniform grid: see trace.glsl.
#ifndef AGLOW_ACCEL_GPU_GRID_GLSL
#define AGLOW_ACCEL_GPU_GRID_GLSL
#include "aglow/accel/gpu/grid/grid_walk.glsl"
#include "aglow/shared/grid.h"

// Tests the triangles of one cell. Returns whether the ray needs to go no further. t of `hit`
// counts from where the ray starts, `offset` before that.
bool test_references(TrianglePtr triangles, uintPtr references, uint first, ShearedRay ray,
                     float near, float offset, uint first_triangle, bool any, inout RayHit hit) {
    for (uint i = first;; ++i) {
        uint reference = references.at[i];
        uint triangle = reference & ~kLastReference;
        AG_COUNT_TRIANGLES;
        TriangleHit found = intersect_triangle(ray, triangles.at[triangle], near, hit.t);
        triangle += first_triangle;
        if (found.hit != 0u && AG_ACCEPT_HIT(triangle, found.barycentrics, found.t + offset)) {
            hit.t = found.t;
            hit.triangle = triangle;
            hit.barycentrics = found.barycentrics;
            if (any) return true;
        }
        if ((reference & kLastReference) != 0u) return false;
    }
}

void trace_grid(uvec2 address, uint first_triangle, RayQuery query, bool any, inout RayHit hit) {
    GridHeader grid = GridHeaderPtr(address).at[0];
    GridEntry entry = enter_grid(grid.shape, query, hit.t);
    if (!entry.inside) return;
    CellRay ray = entry.ray;
    RayHit best = RayHit(hit.t - entry.offset, kNoTriangle, vec2(0.0f));
    ShearedRay sheared = sheared_ray(entry.origin, query.direction);
    uvec3 resolution = grid.shape.resolution;
    ivec3 cell = cell_at(ray, entry.t, ivec3(0), ivec3(resolution) - 1);
    // Through empty cells first, so that the rays of a subgroup meet again at triangles.
    for (;;) {
        bool inside = true;
        uint word;
        for (;;) {
            AG_COUNT_STEPS;
            word = grid.cells.at[cell_index(cell, resolution)];
            if ((word & kEmptyCell) == 0u) break;
            int skip = int(word & ~kEmptyCell);
            vec3 exits = block_exits(ray, cell, skip);
            float exit = min(min(exits.x, exits.y), exits.z);
            cell = cell_behind(ray, cell, skip, exits, exit);
            inside = exit < best.t && is_inside(cell, resolution);
            if (!inside) break;
        }
        if (!inside || test_references(grid.triangles, grid.references, word, sheared, entry.near,
                                       entry.offset, first_triangle, any, best)) {
            break;
        }
        vec3 exits = block_exits(ray, cell, 1);
        float exit = min(min(exits.x, exits.y), exits.z);
        cell = next_cell(ray, cell, exits, exit);
        if (exit >= best.t || !is_inside(cell, resolution)) break;
    }
    if (best.triangle == kNoTriangle) return;
    hit = best;
    hit.t += entry.offset;
}
#endif
