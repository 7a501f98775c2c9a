// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/raster/polygon.h"

namespace aglow::mesh {
namespace {

/// Keeps the side where sign * (coordinate - bound) >= 0; new corners lie exactly on the bound.
template <double Point2::*Axis>
ClipPolygon keep_side(const ClipPolygon& polygon, double bound, double sign) {
    ClipPolygon kept;
    for (int i = 0; i < polygon.count; ++i) {
        const Point2 a = polygon[i], b = polygon[(i + 1) % polygon.count];
        const double da = sign * (a.*Axis - bound), db = sign * (b.*Axis - bound);
        if (da >= 0) kept.add(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            Point2 crossing = a + (b - a) * (da / (da - db));
            crossing.*Axis = bound;
            kept.add(crossing);
        }
    }
    return kept;
}

}  // namespace

double ClipPolygon::signed_area() const {
    double doubled = 0;
    for (int i = 1; i + 1 < count; ++i)
        doubled += cross((*this)[i] - (*this)[0], (*this)[i + 1] - (*this)[0]);
    return doubled / 2;
}

ClipPolygon to_polygon(const Triangle2& triangle) {
    ClipPolygon polygon;
    for (const Point2& p : triangle) polygon.add(p);
    return polygon;
}

ClipPolygon clip_row(const ClipPolygon& polygon, double y0, double y1) {
    return keep_side<&Point2::y>(keep_side<&Point2::y>(polygon, y0, 1), y1, -1);
}

ClipPolygon clip_column(const ClipPolygon& polygon, double x0, double x1) {
    return keep_side<&Point2::x>(keep_side<&Point2::x>(polygon, x0, 1), x1, -1);
}

}  // namespace aglow::mesh
