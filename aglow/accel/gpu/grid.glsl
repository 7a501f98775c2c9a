// SPDX-License-Identifier: Apache-2.0
// Rays through a uniform grid: see trace.glsl.
#ifndef AGLOW_ACCEL_GPU_GRID_GLSL
#define AGLOW_ACCEL_GPU_GRID_GLSL
#include "aglow/accel/gpu/grid_walk.glsl"
#include "aglow/shared/grid.h"

// Tests the triangles of one cell. Returns whether the ray needs to go no further. t of `hit`
// counts from where the ray starts, `offset` before that.
bool test_references(TrianglePtr triangles, uintPtr references, uint first, ShearedRay ray, float near,
                     float offset, uint first_triangle, bool any, inout RayHit hit) {
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
    uvec3 resolution = grid.shape.resolution;
    vec3 cells = vec3(resolution);
    vec3 direction = query.direction * grid.shape.cells_per_length;
    CellRay ray =
        cell_ray((query.origin - grid.shape.lower) * grid.shape.cells_per_length, direction);
    vec2 span = grid_span(ray, cells, query.near, hit.t);
    if (!(span.x <= span.y) || resolution.x == 0u) return;
    float offset = far_start(ray, cells, span.x);
    if (offset > 0.0f) {
        query.origin += query.direction * offset;
        query.near -= offset;
        ray = cell_ray((query.origin - grid.shape.lower) * grid.shape.cells_per_length, direction);
        span.x = 0.0f;
    }

    RayHit best = RayHit(hit.t - offset, kNoTriangle, vec2(0.0f));
    ShearedRay sheared = sheared_ray(query.origin, query.direction);
    ivec3 cell = cell_at(ray, span.x, ivec3(0), ivec3(resolution) - 1);
    do {
        AG_COUNT_STEPS;
        uint word = grid.cells.at[cell_index(cell, resolution)];
        bool empty = (word & kEmptyCell) != 0u;
        if (!empty && test_references(grid.triangles, grid.references, word, sheared, query.near,
                                      offset, first_triangle, any, best)) {
            break;
        }
        int skip = empty ? int(word & ~kEmptyCell) : 1;
        vec3 exits = block_exits(ray, cell, skip);
        float exit = min(min(exits.x, exits.y), exits.z);
        if (exit >= best.t) break;
        cell = cell_behind(ray, cell, skip, exits, exit);
    } while (is_inside(cell, resolution));
    if (best.triangle == kNoTriangle) return;
    hit = best;
    hit.t += offset;
}
#endif
