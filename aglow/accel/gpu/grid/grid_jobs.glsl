// SPDX-License-Identifier: Apache-2.0
// The job that a work item is about: see GridPairsArgs, which are `args`.
#include "aglow/shared/grid2.h"

layout(constant_id = 1) const uint kLevel = kGridOneLevel;

struct Job {
    CellTriangle triangle;
    uvec3 resolution;
    uint first_cell;  // of the job's grid among all cells of the level
    uint index;       // of the triangle
    bool usable;      // false: no cell, and nothing else is known of it
};

Job job(uint i) {
    Job result;
    result.index = kLevel == kGridSecondLevel ? args.upper_values.at[i] : i;
    Triangle t = args.triangles.at[result.index];
    result.usable = kLevel == kGridSecondLevel || is_usable_triangle(t);
    if (!result.usable) return result;
    GridShape shape = args.work.at[0].shape;
    if (kLevel == kGridSecondLevel) {
        uint cell = args.upper_keys.at[i];
        uint row = cell / shape.resolution.x;
        vec3 at =
            vec3(cell % shape.resolution.x, row % shape.resolution.y, row / shape.resolution.y);
        result.resolution = unpacked_resolution(args.leaf_resolutions.at[cell]);
        result.first_cell = args.leaf_bases.at[cell];
        result.triangle = leaf_triangle(shape, t, at, result.resolution);
    } else {
        result.resolution = shape.resolution;
        result.first_cell = 0u;
        result.triangle = grid_triangle(shape, t);
    }
    return result;
}
