// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aglow::mesh {

struct Point3 {
    double x = 0, y = 0, z = 0;
};

inline Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(Point3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point3 cross(Point3 a, Point3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Point3 a);
/// Unit vector along a; zero where a is zero.
Point3 unit(Point3 a);

/// The triangles of a whole mesh with coincident vertices made one, and who lies beside whom.
struct Soup {
    std::vector<Point3> points;                      ///< [point_count] welded positions, m
    std::vector<std::array<uint32_t, 3>> triangles;  ///< [triangle_count] indices into points
    /// [triangle_count] unit normals. A sliver, whose own normal is rounding noise, has that of
    /// the triangle beyond its longest edge.
    std::vector<Point3> normals;
    std::vector<double> areas;  ///< [triangle_count] m^2
    std::vector<char>
        slivers;  ///< [triangle_count] 1 where the height is below kSliverHeight edges
    std::vector<char>
        points_only;  ///< [triangle_count] 1 where two corners coincide: no area at all
    /// [triangle_count] triangle beyond the edge from corner i to corner i + 1, or -1. Where more
    /// than two triangles meet, those that continue each other most smoothly are neighbours.
    std::vector<std::array<int32_t, 3>> neighbors;

    size_t triangle_count() const { return triangles.size(); }
    const Point3& corner(uint32_t triangle, size_t i) const {
        return points[triangles[triangle][i]];
    }
    double edge_length(uint32_t triangle, size_t i) const {
        return length(corner(triangle, (i + 1) % 3) - corner(triangle, i));
    }
};

/// Height over longest edge below which a triangle's normal is not trusted.
inline constexpr double kSliverHeight = 1e-4;

/// Welds exactly equal positions and finds neighbours.
/// Cost  O(n log n).   Repeat  a function of its arguments alone.
Soup make_soup(const std::vector<Point3>& positions, const std::vector<uvec3>& triangles);

}  // namespace aglow::mesh
