// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/raster/polygon.h"

#include <cstdint>
#include <vector>

namespace aglow::mesh {

/// The part of one triangle that lies in one texel.
struct TexelPiece {
    uint32_t triangle = 0;
    ClipPolygon polygon;  ///< in texels of the atlas
    double weight = 0;    ///< world area of the piece, m^2
};

struct PiecePoint {
    size_t piece = 0;
    Point2 point;  ///< in texels of the atlas, inside the piece
};

/// `count` points of a unit square, one in each of `count` rows and columns: their mean is the
/// square's centre.
std::vector<Point2> latin_points(int count);

/// Spreads `pattern.size()` points over the pieces in proportion to their weights. Where the
/// pieces fill the texel evenly the points are the pattern itself.
/// Repeat  a function of its arguments alone.
std::vector<PiecePoint> spread_points(const std::vector<TexelPiece>& pieces, Point2 texel_corner,
                                      const std::vector<Point2>& pattern);

}  // namespace aglow::mesh
