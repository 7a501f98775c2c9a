// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>

namespace aglow::mesh {

struct Point2 {
    double x = 0, y = 0;
};

inline Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
inline Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
inline Point2 operator*(Point2 a, double s) { return {a.x * s, a.y * s}; }
inline double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

/// A triangle cut by up to four axis-parallel lines has at most seven corners.
struct ClipPolygon {
    std::array<Point2, 8> corners;
    int count = 0;

    void add(Point2 p) { corners[static_cast<size_t>(count++)] = p; }
    const Point2& operator[](int i) const { return corners[static_cast<size_t>(i)]; }
    double signed_area() const;
};

using Triangle2 = std::array<Point2, 3>;

/// Twice the signed area; positive for counter-clockwise corners.
inline double doubled_area(const Triangle2& t) { return cross(t[1] - t[0], t[2] - t[0]); }

ClipPolygon to_polygon(const Triangle2& triangle);
/// The part with y0 <= y <= y1 (row) or x0 <= x <= x1 (column).
/// Source  Sutherland & Hodgman, "Reentrant Polygon Clipping", CACM 1974.
ClipPolygon clip_row(const ClipPolygon& polygon, double y0, double y1);
ClipPolygon clip_column(const ClipPolygon& polygon, double x0, double x1);

}  // namespace aglow::mesh
