// SPDX-License-Identifier: Apache-2.0
// What the kernels that build a uniform grid read and write.
#ifndef AGLOW_SHARED_GRID_BUILD_H
#define AGLOW_SHARED_GRID_BUILD_H
#include "aglow/shared/grid.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kGridGroupSize = 64u;
// Triangles whose bounds one invocation merges before it adds them to all others'.
AG_CONST uint kBoundsPerInvocation = 16u;
// Columns of cells that one invocation looks at. A job with more of them is shared by several: work
// item i < job_count takes the first columns of job i, items behind those the rest.
AG_CONST uint kColumnsPerItem = 64u;
// Distances to the next occupied cell are known in powers of two, up to 2^(kSkipLevels - 1) cells.
AG_CONST uint kSkipLevels = 5u;

// What the build finds on the device and the host reads. A sum is x + 4096 y.
struct GridWork {
    uvec3 lower, upper;  // bounds of all usable triangles, as integers of the same order
    GridShape shape;
    uvec2 extras;     // work items besides the first one of each job
    uvec2 pairs;      // of a cell and a triangle that overlaps it
    uint leaf_cells;  // two-level grid: cells of its second level
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

// A job puts a triangle into the cells of a grid: into the uniform grid or the first level of a
// two-level grid, or, one of its pairs, into the grid in a cell of the first level.
struct GridPairsArgs {
    uint first_group;
    uint job_count;
    uint item_count;  // >= job_count; some of the last ones may find nothing to do
    uint unused;
    TrianglePtr triangles;
    GridWorkPtr work;
    uintPtr extras;  // [job_count] items of a job besides the first; then their exclusive sums,
                     // which are not read where item_count = job_count
    uintPtr counts;  // [item_count] how many pairs each makes; then where they begin
    uintPtr keys, values;                  // cells and triangles
    uintPtr upper_keys, upper_values;      // [job_count] second level: pairs of the first
    uintPtr leaf_resolutions, leaf_bases;  // second level: for each cell of the first
};

struct GridCellsArgs {
    uint first_group;
    uint count;
    uintPtr keys, values;  // [count] pairs in order of cells
    uintPtr cells;         // first pairs of occupied cells
    uintPtr ends;          // first level of two: [cells] behind their last pairs
    uintPtr references;    // else: [count]
    uintPtr occupied;      // but for the second level: a bit per cell, rows of whole words
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
    uintPtr occupied;  // a bit per cell, then, level after level, whether an occupied cell is
                       // within 2^level cells
    uvec3 resolution;
};

// Variants of grid_split and grid_pairs (constant 1), grid_cells (constant 0).
AG_CONST uint kGridOneLevel = 0u;
AG_CONST uint kGridFirstLevel = 1u;
AG_CONST uint kGridSecondLevel = 2u;

// Words that a row of cells takes at a bit each.
AG_FN uint row_words(uint cells) { return (cells + 31u) / 32u; }

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::GridWork) == 80);
static_assert(sizeof(aglow::shared::GridPairsArgs) == 96);
#endif
#endif
