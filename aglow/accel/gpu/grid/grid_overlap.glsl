// SPDX-License-Identifier: Apache-2.0
// Work items of triangles over many cells, and the cells that an item overlaps.

// The triangle of extra item `extra`: the last one whose sum of the extra items before it, sums[],
// is not above it.
uint item_owner(uintPtr sums, uint count, uint extra) {
    uint low = 0u;
    uint high = count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (sums.at[middle] <= extra) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The cells that columns [chunk * kColumnsPerItem, ...) of the triangle overlap: their number, and
// for each `AG_VISIT_CELL(cell, how many came before)`, in a grid of this resolution.
uint visit_cells(CellTriangle t, uint chunk, uvec3 resolution) {
    uint row = resolution.x;
    uint slice = resolution.x * resolution.y;
    uvec3 stride = t.axis == 0u   ? uvec3(row, slice, 1u)
                   : t.axis == 1u ? uvec3(slice, 1u, row)
                                  : uvec3(1u, row, slice);
    uvec3 first = uvec3(t.first);
    uint corner = first.x * stride.x + first.y * stride.y + first.z * stride.z;
    uint width = uint(t.size.x);
    uint column = chunk * kColumnsPerItem;
    uint end = min(column + kColumnsPerItem, column_count(t));
    uint x = column % width;
    uint y = column / width;
    uint found = 0u;
    for (; column < end; ++column) {
        vec2 range = column_range(t, float(x), float(y));
        for (float z = range.x; z <= range.y; z += 1.0f) {
            if (!overlaps_cell(t, float(x), float(y), z)) continue;
            uint cell = corner + x * stride.x + y * stride.y + uint(z) * stride.z;
            AG_VISIT_CELL(cell, found);
            ++found;
        }
        bool wrap = ++x == width;
        x = wrap ? 0u : x;
        y += wrap ? 1u : 0u;
    }
    return found;
}
