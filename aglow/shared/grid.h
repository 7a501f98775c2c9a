// SPDX-License-Identifier: Apache-2.0
// The uniform grid: its shape, and its contents as rays read them.
//
// Source: Ivson, Duarte & Celes, "GPU-Accelerated Uniform Grid Construction for Ray Tracing Dynamic
// Scenes", 2009 (cells by sorted pairs); Wald et al., "Ray Tracing Animated Scenes Using Coherent
// Grid Traversal", SIGGRAPH 2006 (resolution).
#ifndef AGLOW_SHARED_GRID_H
#define AGLOW_SHARED_GRID_H
#include "aglow/shared/triangle_box.h"
AG_NAMESPACE_BEGIN

// A box cut into cells. Cell (x, y, z) has index x + resolution.x * (y + resolution.y * z).
struct GridShape {
    vec3 lower;
    vec3 cells_per_length;
    uvec3 resolution;  // all 0: no box
};

// A word per cell. Occupied: the index of its first reference. Empty: kEmptyCell + s, where all
// cells less than s away along each axis are empty, s >= 1.
AG_CONST uint kEmptyCell = 0x80000000u;
// A reference is the index of a triangle; the last one of a cell has this bit.
AG_CONST uint kLastReference = 0x80000000u;

// What the traversal reads. triangles: as they were given; those that cannot be hit are in no cell.
struct GridHeader {
    TrianglePtr triangles;
    uintPtr cells;
    uintPtr references;
    GridShape shape;
};
AG_BUFFER_OF(GridHeader);

AG_CONST uint kMaxGridAxis = 2048u;

AG_FN float largest(vec3 v) { return max(max(v.x, v.y), v.z); }

// How far, in cells, rounding may move a ray or a triangle of a grid with `cells` along its longest
// axis. With rays that start less than 4 such lengths away, positions are off by up to 2^-23 * 4
// cells, crossings of planes by 3 * 2^-24 * 9 cells and the triangle test by about as much: 2^-17
// is above their sum.
AG_FN float grid_margin(float cells) { return 9.765625e-4f + 7.6293945e-6f * cells; }

AG_FN uint grid_axis(float cells) {
    return cells < 1.0f ? 1u : cells > float(kMaxGridAxis) ? kMaxGridAxis : uint(cells);
}

// Cells per length for about `cells` cubic cells in a box of this size. Axes too short for two
// cells do not count: over a flat box cells are squares, along a line lengths.
AG_FN float grid_density(vec3 size, float cells) {
    float d = 0.0f;
    bool x = size.x > 0.0f;
    bool y = size.y > 0.0f;
    bool z = size.z > 0.0f;
    for (int round = 0; round < 3; ++round) {
        float axes = (x ? 1.0f : 0.0f) + (y ? 1.0f : 0.0f) + (z ? 1.0f : 0.0f);
        if (axes == 0.0f) return d;
        d = pow(cells, 1.0f / axes) / pow((x ? size.x : 1.0f), 1.0f / axes) /
            pow((y ? size.y : 1.0f), 1.0f / axes) / pow((z ? size.z : 1.0f), 1.0f / axes);
        x = x && size.x * d >= 1.0f;
        y = y && size.y * d >= 1.0f;
        z = z && size.z * d >= 1.0f;
    }
    return d;
}

// The grid over finite bounds with about `cells` cells. It reaches beyond the bounds by some of a
// cell, so that no triangle lies on its outer faces.
AG_FN GridShape grid_shape(Bounds bounds, float cells) {
    vec3 size = bounds.upper - bounds.lower;
    float density = grid_density(size, cells);
    GridShape s;
    s.resolution.x = grid_axis(size.x * density);
    s.resolution.y = grid_axis(size.y * density);
    s.resolution.z = grid_axis(size.z * density);
    vec3 cell;
    cell.x = size.x / float(s.resolution.x);
    cell.y = size.y / float(s.resolution.y);
    cell.z = size.z / float(s.resolution.z);
    float magnitude =
        max(largest(max(bounds.upper, -bounds.lower)), largest(max(-bounds.upper, bounds.lower)));
    // 1/16 of a cell, but no less than some units in the last place.
    float border = max(max(0.0625f * largest(cell), 4.7683716e-7f * magnitude), 1e-30f);
    s.lower.x = bounds.lower.x - border;
    s.lower.y = bounds.lower.y - border;
    s.lower.z = bounds.lower.z - border;
    s.cells_per_length.x = float(s.resolution.x) / (size.x + 2.0f * border);
    s.cells_per_length.y = float(s.resolution.y) / (size.y + 2.0f * border);
    s.cells_per_length.z = float(s.resolution.z) / (size.z + 2.0f * border);
    return s;
}

AG_FN vec3 grid_extent(GridShape s) {
    vec3 cells;
    cells.x = float(s.resolution.x);
    cells.y = float(s.resolution.y);
    cells.z = float(s.resolution.z);
    return cells;
}

AG_FN CellTriangle grid_triangle(GridShape s, Triangle t) {
    vec3 cells = grid_extent(s);
    return cell_triangle((t.a - s.lower) * s.cells_per_length, (t.b - s.lower) * s.cells_per_length,
                         (t.c - s.lower) * s.cells_per_length, cells, grid_margin(largest(cells)));
}

AG_NAMESPACE_END
#endif
