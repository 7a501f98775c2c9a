// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/raster/polygon.h"

#include <algorithm>
#include <cmath>

namespace aglow::mesh {

/// Share of a texel below which a triangle larger than the texel does not cover it: less than the
/// rounding of float UVs moves a chart's border in an atlas of 512 texels.
inline constexpr double kLeastCover = 1e-5;

/// Calls visit(x, y, polygon) for every unit square of a width x height grid that `triangle`
/// overlaps, where polygon is the overlap. Squares come row by row. The triangle must be
/// counter-clockwise. Cost  O(squares visited).
template <class Visit>
void for_each_covered_square(const Triangle2& triangle, int width, int height, Visit visit) {
    const double least = std::min(kLeastCover, 1e-6 * doubled_area(triangle));
    const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    const int first_row = std::max(0, static_cast<int>(std::floor(low)));
    const int last_row = std::min(height - 1, static_cast<int>(std::floor(high)));
    const ClipPolygon whole = to_polygon(triangle);
    for (int y = first_row; y <= last_row; ++y) {
        const ClipPolygon row = clip_row(whole, y, y + 1);
        if (row.count < 3) continue;
        double left = row[0].x, right = row[0].x;
        for (int i = 1; i < row.count; ++i) {
            left = std::min(left, row[i].x);
            right = std::max(right, row[i].x);
        }
        const int first = std::max(0, static_cast<int>(std::floor(left)));
        const int last = std::min(width - 1, static_cast<int>(std::floor(right)));
        for (int x = first; x <= last; ++x) {
            const ClipPolygon square = clip_column(row, x, x + 1);
            if (square.count >= 3 && square.signed_area() > least) visit(x, y, square);
        }
    }
}

}  // namespace aglow::mesh
