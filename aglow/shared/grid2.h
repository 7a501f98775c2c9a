// SPDX-License-Identifier: Apache-2.0
// The two-level grid: a coarse uniform grid, each of whose occupied cells holds a grid of its own,
// as fine as the triangles in it are many.
//
// Source: Kalojanov, Billeter & Slusallek, "Two-Level Grids for Ray Tracing on GPUs", Eurographics
// 2011.
#ifndef AGLOW_SHARED_GRID2_H
#define AGLOW_SHARED_GRID2_H
#include "aglow/shared/grid_build.h"
AG_NAMESPACE_BEGIN

// What the traversal reads.
struct Grid2Header {
    TrianglePtr triangles;
    uintPtr cells;             // as in a GridHeader, but an occupied one holds its first leaf cell
    uintPtr leaf_resolutions;  // of occupied cells: packed_resolution()
    uintPtr leaf_cells;        // as in a GridHeader; empty ones hold no distance
    uintPtr references;
    GridShape shape;
};
AG_BUFFER_OF(Grid2Header);

struct Grid2LeavesArgs {
    uint first_group;
    uint count;          // of cells
    float per_triangle;  // leaf cells wanted per triangle of a cell
    uint unused;
    GridWorkPtr work;
    uintPtr begins, ends;  // pairs of each cell; ends = 0: none
    uintPtr leaf_resolutions;
    uintPtr leaf_counts;  // leaf cells of each cell
};

AG_CONST uint kMaxLeafAxis = 255u;

AG_FN uint packed_resolution(uvec3 r) { return r.x | (r.y << 8u) | (r.z << 16u); }

AG_FN uvec3 unpacked_resolution(uint packed) {
    uvec3 r;
    r.x = packed & 255u;
    r.y = (packed >> 8u) & 255u;
    r.z = packed >> 16u;
    return r;
}

// The grid in a cell of this shape for about `cells` leaf cells. Rounds to the nearest: always down
// would make cells with few triangles half as fine as wanted.
AG_FN uvec3 leaf_resolution(GridShape shape, float cells) {
    vec3 size;
    size.x = 1.0f / shape.cells_per_length.x;
    size.y = 1.0f / shape.cells_per_length.y;
    size.z = 1.0f / shape.cells_per_length.z;
    float density = grid_density(size, cells);
    uvec3 r;
    r.x = min(grid_axis(size.x * density + 0.5f), kMaxLeafAxis);
    r.y = min(grid_axis(size.y * density + 0.5f), kMaxLeafAxis);
    r.z = min(grid_axis(size.z * density + 0.5f), kMaxLeafAxis);
    return r;
}

// A triangle in the grid in cell (x, y, z): in units of its leaf cells, whose margin is that of a
// grid as fine everywhere.
AG_FN CellTriangle leaf_triangle(GridShape shape, Triangle t, vec3 cell, uvec3 resolution) {
    vec3 leaves;
    leaves.x = float(resolution.x);
    leaves.y = float(resolution.y);
    leaves.z = float(resolution.z);
    vec3 a = ((t.a - shape.lower) * shape.cells_per_length - cell) * leaves;
    vec3 b = ((t.b - shape.lower) * shape.cells_per_length - cell) * leaves;
    vec3 c = ((t.c - shape.lower) * shape.cells_per_length - cell) * leaves;
    float finest = largest(grid_extent(shape)) * largest(leaves);
    return cell_triangle(a, b, c, leaves, grid_margin(finest));
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::Grid2Header) == 80);
#endif
#endif
