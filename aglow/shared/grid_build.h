// SPDX-License-Identifier: Apache-2.0
// What the kernels that build a uniform grid read and write.
#ifndef AGLOW_SHARED_GRID_BUILD_H
#define AGLOW_SHARED_GRID_BUILD_H
#include "aglow/shared/grid.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kGridGroupSize = 64u;
// Triangles whose bounds one invocation merges before it adds them to all others'.
AG_CONST uint kBoundsPerInvocation = 16u;
// Columns of cells that one invocation looks at. A triangle over more of them is shared by several:
// work item i < triangle_count takes the first columns of triangle i, items behind those the rest.
AG_CONST uint kColumnsPerItem = 64u;
// Distances to the next occupied cell are known in powers of two, up to 2^(kSkipLevels - 1) cells.
AG_CONST uint kSkipLevels = 5u;

// What the build counts on the device and the host reads once. A sum is x + 4096 y.
struct GridWork {
    uvec3 lower, upper;  // bounds of all usable triangles, by ordered_bits()
    uvec2 extras;        // work items besides the first one of each triangle
    uvec2 pairs;         // of a cell and a triangle that overlaps it
    GridShape shape;
};
AG_BUFFER_OF(GridWork);

struct GridBoundsArgs {
    uint first_group;
    uint count;
    TrianglePtr from, to;
    GridWorkPtr work;
};

struct GridShapeArgs {
    uint first_group;
    float cells;  // about how many are wanted
    GridWorkPtr work;
};

struct GridSplitArgs {
    uint first_group;
    uint count;
    TrianglePtr triangles;
    GridWorkPtr work;
    uintPtr extras;  // [count] work items besides the first
};

struct GridPairsArgs {
    uint first_group;
    uint triangle_count;
    uint item_count;  // >= triangle_count; some of the last ones may find nothing to do
    TrianglePtr triangles;
    GridWorkPtr work;
    uintPtr extras;  // [triangle_count] their exclusive sums; not read without extra items
    uintPtr counts;  // [item_count] how many pairs each makes, or where they begin
    uintPtr keys;    // cells
    uintPtr values;  // triangles
};

struct GridCellsArgs {
    uint first_group;
    uint count;
    uintPtr keys, values;  // [count] pairs in order of cells
    uintPtr cells;
    uintPtr references;  // [count]
    uintPtr occupied;    // a bit per cell, rows of whole words
    uvec3 resolution;
};

struct GridSpreadArgs {
    uint first_group;
    uint step;
    uintPtr from, to;  // a bit per cell
    uvec3 resolution;
};

struct GridSkipArgs {
    uint first_group;
    uint levels;
    uintPtr cells;
    uintPtr occupied;  // level after level: bits of the cells within 2^level of an occupied one
    uvec3 resolution;
};

// Words that a row of cells takes at a bit each.
AG_FN uint row_words(uint cells) { return (cells + 31u) / 32u; }

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::GridWork) == 76);
static_assert(sizeof(aglow::shared::GridPairsArgs) == 64);
#endif
#endif
