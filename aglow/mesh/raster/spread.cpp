// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/raster/spread.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aglow::mesh {
namespace {

/// Squared distance on the torus between two points of a lattice of n x n cells.
int torus_distance(int dx, int dy, int n) {
    const int x = std::min(dx, n - dx), y = std::min(dy, n - dy);
    return x * x + y * y;
}

/// The multiplier whose lattice (k, k * multiplier mod n) keeps its points farthest apart.
int best_multiplier(int n) {
    int best = 1, best_distance = -1;
    for (int g = 1; g < n; ++g) {
        if (std::gcd(g, n) != 1) continue;
        int nearest = 2 * n * n;
        for (int k = 1; k < n; ++k) nearest = std::min(nearest, torus_distance(k, k * g % n, n));
        if (nearest > best_distance) best = g, best_distance = nearest;
    }
    return best;
}

bool contains(const ClipPolygon& polygon, Point2 p) {
    for (int i = 0; i < polygon.count; ++i) {
        const Point2 a = polygon[i], b = polygon[(i + 1) % polygon.count];
        if (cross(b - a, p - a) < 0) return false;
    }
    return polygon.count >= 3;
}

/// Whether the pieces cover the whole texel, at one density.
bool fills_evenly(const std::vector<TexelPiece>& pieces) {
    double area = 0, lo = 0, hi = 0;
    for (const TexelPiece& piece : pieces) {
        const double piece_area = piece.polygon.signed_area();
        const double density = piece.weight / piece_area;
        lo = area == 0 ? density : std::min(lo, density);
        hi = std::max(hi, density);
        area += piece_area;
    }
    return std::abs(area - 1) < 1e-3 && hi <= 1.05 * lo;
}

Point2 centroid(const ClipPolygon& polygon) {
    Point2 sum;
    for (int i = 0; i < polygon.count; ++i) sum = sum + polygon[i];
    return sum * (1.0 / polygon.count);
}

/// Pulled inwards by a hair, so that rounding to float barycentrics cannot leave the triangle.
Point2 pull_inside(const ClipPolygon& polygon, Point2 p) {
    constexpr double kHair = 1e-3;
    return p + (centroid(polygon) - p) * kHair;
}

/// Point at the share `at` (0..1) of the polygon's area, counted fan triangle by fan triangle
/// and from the first corner outwards in each; `across` runs along the far edge.
Point2 point_at(const ClipPolygon& polygon, double at, double across) {
    double remaining = at * polygon.signed_area();
    for (int i = 1; i + 1 < polygon.count; ++i) {
        const Point2 a = polygon[0], b = polygon[i], c = polygon[i + 1];
        const double area = cross(b - a, c - a) / 2;
        if (remaining > area && i + 2 < polygon.count) {
            remaining -= area;
            continue;
        }
        const double outwards = area > 0 ? std::sqrt(std::clamp(remaining / area, 0.0, 1.0)) : 0.5;
        return a + ((b - a) * (1 - across) + (c - a) * across) * outwards;
    }
    return polygon[0];
}

std::vector<PiecePoint> spread_by_area(const std::vector<TexelPiece>& pieces,
                                       const std::vector<Point2>& pattern) {
    double total = 0;
    for (const TexelPiece& piece : pieces) total += piece.weight;
    std::vector<PiecePoint> points;
    size_t current = 0;
    double before = 0;
    for (const Point2& strata : pattern) {  // strata.x increases from point to point
        const double wanted = strata.x * total;
        while (current + 1 < pieces.size() && before + pieces[current].weight < wanted)
            before += pieces[current++].weight;
        const TexelPiece& piece = pieces[current];
        const double at = std::clamp((wanted - before) / piece.weight, 0.0, 1.0);
        const Point2 p = point_at(piece.polygon, at, strata.y);
        points.push_back({current, pull_inside(piece.polygon, p)});
    }
    return points;
}

}  // namespace

std::vector<Point2> latin_points(int count) {
    const int g = best_multiplier(count + 1);
    std::vector<Point2> points;
    for (int k = 1; k <= count; ++k) {
        const int row = k * g % (count + 1) - 1;
        points.push_back({(k - 0.5) / count, (row + 0.5) / count});
    }
    return points;
}

std::vector<PiecePoint> spread_points(const std::vector<TexelPiece>& pieces, Point2 texel_corner,
                                      const std::vector<Point2>& pattern) {
    if (!fills_evenly(pieces)) return spread_by_area(pieces, pattern);
    std::vector<PiecePoint> points;
    for (const Point2& offset : pattern) {
        const Point2 p = texel_corner + offset;
        const auto holder = std::find_if(pieces.begin(), pieces.end(), [&](const TexelPiece& t) {
            return contains(t.polygon, p);
        });
        if (holder == pieces.end()) return spread_by_area(pieces, pattern);
        points.push_back(
            {static_cast<size_t>(holder - pieces.begin()), pull_inside(holder->polygon, p)});
    }
    return points;
}

}  // namespace aglow::mesh
