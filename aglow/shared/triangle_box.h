// SPDX-License-Identifier: Apache-2.0
// Which cells of a grid a triangle overlaps, exactly but for a margin: column by column.
//
// Lengths are in cells: cell (x, y, z) is the cube from there to (x + 1, y + 1, z + 1). Each cell
// counts as grown by the margin on all sides, which is chosen larger than all rounding here and in
// the walk of a ray, so that no hit is lost between two cells.
//
// Source: Schwarz & Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia
// 2010: a triangle overlaps a box where its plane does and where its three projections overlap the
// box's, which is the separating axis theorem of Akenine-Moller, "Fast 3D Triangle-Box Overlap
// Testing", JGT 2001, with its axes sorted by use.
#ifndef AGLOW_SHARED_TRIANGLE_BOX_H
#define AGLOW_SHARED_TRIANGLE_BOX_H
#include "aglow/shared/triangle.h"
AG_NAMESPACE_BEGIN

// A projection of a triangle onto two axes: a cell overlaps it where all three of
// line.x * u + line.y * v + line.z >= 0 with (u, v) the cell's lower corner.
struct ProjectedTriangle {
    vec3 ab, bc, ca;
};

// A triangle made ready for tests against cells. Its axes are permuted to make z the one along
// which its plane rises least, and cells count from the first one of its box.
struct CellTriangle {
    vec3 first;  // cell of the box's lower corner
    vec3 size;   // cells of the box along each axis; <= 0: it lies beside the grid
    ProjectedTriangle xy, yz, zx;
    vec3 plane;    // the plane's height at (x, y) is plane.x * x + plane.y * y + plane.z
    float spread;  // how far from that height the triangle's part over a column's corner may be
    uint axis;     // which axis became z
    uint filled;   // 1: it overlaps all cells of its box
};

// An edge shorter than the margin bounds nothing: where a triangle is seen edge-on, rounding
// decides on which side of it the triangle seems to lie.
AG_FN vec3 cell_line(float pu, float pv, float qu, float qv, float side, float margin) {
    bool is_short = abs(pu - qu) + abs(pv - qv) < margin;
    float u = is_short ? 0.0f : side * (pv - qv);
    float v = is_short ? 0.0f : side * (qu - pu);
    vec3 line;
    line.x = u;
    line.y = v;
    line.z = max(u, 0.0f) + max(v, 0.0f) + margin * (abs(u) + abs(v)) - (u * pu + v * pv);
    return line;
}

AG_FN ProjectedTriangle project_triangle(float au, float av, float bu, float bv, float cu, float cv,
                                         float area, float margin) {
    float side = area < 0.0f ? -1.0f : 1.0f;
    ProjectedTriangle p;
    p.ab = cell_line(au, av, bu, bv, side, margin);
    p.bc = cell_line(bu, bv, cu, cv, side, margin);
    p.ca = cell_line(cu, cv, au, av, side, margin);
    return p;
}

AG_FN bool overlaps_projection(ProjectedTriangle p, float u, float v) {
    return p.ab.x * u + p.ab.y * v + p.ab.z >= 0.0f && p.bc.x * u + p.bc.y * v + p.bc.z >= 0.0f &&
           p.ca.x * u + p.ca.y * v + p.ca.z >= 0.0f;
}

AG_FN float first_cell_of(float lower) { return max(floor(lower), 0.0f); }
AG_FN float cells_between(float first, float upper, float cells) {
    return min(floor(upper), cells - 1.0f) - first + 1.0f;
}

// a, b, c are corners of a usable triangle, `cells` the grid's resolution, both in cells.
AG_FN CellTriangle cell_triangle(vec3 a, vec3 b, vec3 c, vec3 cells, float margin) {
    CellTriangle t;
    vec3 lower = min(min(a, b), c);
    vec3 upper = max(max(a, b), c);
    vec3 n = cross(b - a, c - a);
    float x = abs(n.x);
    float y = abs(n.y);
    float z = abs(n.z);
    t.axis = x > y ? (x > z ? 0u : 2u) : (y > z ? 1u : 2u);
    n = permuted(n, t.axis);

    vec3 first;
    first.x = first_cell_of(lower.x - margin);
    first.y = first_cell_of(lower.y - margin);
    first.z = first_cell_of(lower.z - margin);
    vec3 size;
    size.x = cells_between(first.x, upper.x + margin, cells.x);
    size.y = cells_between(first.y, upper.y + margin, cells.y);
    size.z = cells_between(first.z, upper.z + margin, cells.z);
    t.first = permuted(first, t.axis);
    t.size = permuted(size, t.axis);
    // A triangle is connected: one that stays within a row of cells is in all from first to last.
    float wide = (floor(upper.x + margin) > floor(lower.x - margin) ? 1.0f : 0.0f) +
                 (floor(upper.y + margin) > floor(lower.y - margin) ? 1.0f : 0.0f) +
                 (floor(upper.z + margin) > floor(lower.z - margin) ? 1.0f : 0.0f);
    t.filled = wide < 2.0f ? 1u : 0u;

    vec3 p = permuted(a - first, t.axis);
    vec3 q = permuted(b - first, t.axis);
    vec3 r = permuted(c - first, t.axis);
    t.xy = project_triangle(p.x, p.y, q.x, q.y, r.x, r.y, n.z, margin);
    t.yz = project_triangle(p.y, p.z, q.y, q.z, r.y, r.z, n.x, margin);
    t.zx = project_triangle(p.z, p.x, q.z, q.x, r.z, r.x, n.y, margin);

    // A normal that is mostly rounding error, up to 2^-22 extent^2, makes the plane useless; the
    // spread then grows past the box.
    vec3 extent = upper - lower;
    float e = max(max(extent.x, extent.y), extent.z);
    bool level = abs(n.z) > 1e-30f;
    t.plane.x = level ? -n.x / n.z : 0.0f;
    t.plane.y = level ? -n.y / n.z : 0.0f;
    t.plane.z = p.z - (t.plane.x * p.x + t.plane.y * p.y);
    float slope = 1.0f + abs(t.plane.x) + abs(t.plane.y);
    t.spread = level ? margin * slope + 9.5367432e-7f * e * e * (e / abs(n.z)) : margin * slope + e;
    return t;
}

// Columns of cells along z that the triangle's box has.
AG_FN uint column_count(CellTriangle t) {
    return uint(max(t.size.x, 0.0f)) * uint(max(t.size.y, 0.0f));
}

// First and last z of the cells of a column that the triangle may overlap; first > last: none.
AG_FN vec2 column_range(CellTriangle t, float x, float y) {
    vec2 range;
    range.x = 0.0f;
    range.y = t.size.z - 1.0f;
    if (t.filled != 0u) return range;
    if (!overlaps_projection(t.xy, x, y)) {
        range.y = -1.0f;
        return range;
    }
    float height = t.plane.x * x + t.plane.y * y + t.plane.z;
    float low = height + min(t.plane.x, 0.0f) + min(t.plane.y, 0.0f) - t.spread;
    float high = height + max(t.plane.x, 0.0f) + max(t.plane.y, 0.0f) + t.spread;
    range.x = max(range.x, floor(low));
    range.y = min(range.y, floor(high));
    return range;
}

// Whether the triangle overlaps a cell of a column's range.
AG_FN bool overlaps_cell(CellTriangle t, float x, float y, float z) {
    return t.filled != 0u || (overlaps_projection(t.yz, y, z) && overlaps_projection(t.zx, z, x));
}

AG_NAMESPACE_END
#endif
