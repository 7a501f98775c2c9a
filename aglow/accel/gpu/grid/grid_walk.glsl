// SPDX-License-Identifier: Apache-2.0
// Walks of a ray from cell to cell.
//
// Source: Amanatides & Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987.
// Where a ray crosses a plane between cells is computed from the plane's number and not by adding
// up steps, so that errors do not grow along the way; a block of empty cells is crossed in one
// step.
#ifndef AGLOW_ACCEL_GPU_GRID_WALK_GLSL
#define AGLOW_ACCEL_GPU_GRID_WALK_GLSL
#include "aglow/shared/grid.h"
#include "aglow/shared/triangle.h"

// A ray in units of cells: plane number i of an axis is crossed at t = i * inverse + bias.
struct CellRay {
    vec3 origin;
    vec3 direction;
    vec3 inverse;  // 0 along axes that the ray does not move along, whose bias is out of reach
    vec3 bias;
};

const float kNeverCrossed = 3.0e38f;

// An axis along which the ray moves less than 2^-30 of the way along its longest one, that is less
// than the margin of cells on its way through any grid, counts as one it does not move along.
CellRay cell_ray(vec3 origin, vec3 direction) {
    CellRay ray;
    ray.origin = origin;
    ray.direction = direction;
    float longest = largest(abs(direction));
    bvec3 still = lessThanEqual(abs(direction), vec3(longest * 9.3e-10f));
    ray.inverse = mix(1.0f / mix(direction, vec3(1.0f), still), vec3(0.0f), still);
    ray.bias = mix(-origin * ray.inverse, vec3(kNeverCrossed), still);
    return ray;
}

// Where the ray is between the first and the last planes of all axes: t from x to y. x > y:
// nowhere.
vec2 grid_span(CellRay ray, vec3 cells, float near, float far) {
    bvec3 still = equal(ray.inverse, vec3(0.0f));
    if (any(lessThan(mix(vec3(0.0f), ray.origin, still), vec3(0.0f))) ||
        any(greaterThan(mix(vec3(0.0f), ray.origin, still), cells))) {
        return vec2(1.0f, 0.0f);
    }
    vec3 a = mix(ray.bias, vec3(-kNeverCrossed), still);
    vec3 b = cells * ray.inverse + ray.bias;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, near)),
                min(min(high.x, high.y), min(high.z, far)));
}

// The cell that the ray is in at t.
ivec3 cell_at(CellRay ray, float t, ivec3 low, ivec3 high) {
    return clamp(ivec3(floor(ray.origin + ray.direction * t)), low, high);
}

// t of the planes through which the ray leaves the cells less than `skip` away from `cell`.
vec3 block_exits(CellRay ray, ivec3 cell, int skip) {
    ivec3 plane = cell + mix(ivec3(skip), ivec3(1 - skip), lessThan(ray.inverse, vec3(0.0f)));
    return vec3(plane) * ray.inverse + ray.bias;
}

// The first cell behind that block, entered at t = `exit`, the smallest of `exits`. A coordinate
// that does not leave the block stays within it, on the ray's side of `cell`, whatever the
// rounding: so the walk ends.
ivec3 cell_behind(CellRay ray, ivec3 cell, int skip, vec3 exits, float exit) {
    bvec3 backward = lessThan(ray.inverse, vec3(0.0f));
    ivec3 within = ivec3(skip - 1);
    ivec3 inside = cell_at(ray, exit, cell - mix(ivec3(0), within, backward),
                           cell + mix(within, ivec3(0), backward));
    ivec3 outside = cell + mix(ivec3(skip), ivec3(-skip), backward);
    return mix(inside, outside, equal(exits, vec3(exit)));
}

// The cell that the ray enters at t = `exit`, the smallest of `exits`.
ivec3 next_cell(CellRay ray, ivec3 cell, vec3 exits, float exit) {
    ivec3 step = mix(ivec3(1), ivec3(-1), lessThan(ray.inverse, vec3(0.0f)));
    return cell + mix(ivec3(0), step, equal(exits, vec3(exit)));
}

bool is_inside(ivec3 cell, uvec3 resolution) { return all(lessThan(uvec3(cell), resolution)); }

uint cell_index(ivec3 cell, uvec3 resolution) {
    return uint(cell.x) + resolution.x * (uint(cell.y) + resolution.y * uint(cell.z));
}

// A ray on its way through a grid. One that starts far off the grid would lose its place to
// rounding, so it is made to start where it enters: t counts from there, `offset` less.
struct GridWalk {
    bool inside;  // false: the ray meets no cell
    CellRay ray;
    ShearedRay sheared;
    float offset;
    float near;
    float enter;  // t at which the ray enters `cell`
    ivec3 cell;
    RayHit best;  // the nearest so far
};

// A walk's first cell; hits count below hit.t only.
GridWalk enter_grid(GridShape shape, RayQuery query, RayHit hit) {
    GridWalk walk;
    vec3 cells = vec3(shape.resolution);
    vec3 direction = query.direction * shape.cells_per_length;
    vec3 origin = query.origin;
    walk.offset = 0.0f;
    walk.near = query.near;
    walk.ray = cell_ray((origin - shape.lower) * shape.cells_per_length, direction);
    vec2 span = grid_span(walk.ray, cells, query.near, hit.t);
    walk.enter = span.x;
    walk.inside = span.x <= span.y && shape.resolution.x != 0u;
    vec3 away = max(walk.ray.origin - cells, -walk.ray.origin);
    if (walk.enter > 0.0f && largest(away) > 4.0f * largest(cells)) {  // see grid_margin()
        walk.offset = walk.enter;
        origin += query.direction * walk.offset;
        walk.near -= walk.offset;
        walk.ray = cell_ray((origin - shape.lower) * shape.cells_per_length, direction);
        walk.enter = 0.0f;
    }
    walk.sheared = sheared_ray(origin, query.direction);
    walk.cell = cell_at(walk.ray, walk.enter, ivec3(0), ivec3(shape.resolution) - 1);
    walk.best = RayHit(hit.t - walk.offset, kNoTriangle, vec2(0.0f));
    return walk;
}

// Lowers `hit` to what the walk found, t counted from the ray's own start.
void leave_grid(GridWalk walk, inout RayHit hit) {
    if (walk.best.triangle == kNoTriangle) return;
    hit = walk.best;
    hit.t += walk.offset;
}
#endif
