// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/random.h"
#include "aglow/shared/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::accel::gpu {

/// What the grids are tested against: plain formulas in double precision.
struct Vec3d {
    double x, y, z;
};
inline Vec3d to_double(vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(Vec3d a, Vec3d b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Whether the triangle and the box from `lower`, grown by `margin`, have a point in common: all 13
/// axes that can separate them are tried. Source  Akenine-Moller, JGT 2001.
inline bool overlaps_box(const shared::Triangle& t, Vec3d lower, Vec3d size, double margin) {
    const Vec3d center = lower + size * 0.5;
    const std::array<double, 3> half = {size.x / 2 + margin, size.y / 2 + margin,
                                        size.z / 2 + margin};
    const std::array<Vec3d, 3> p = {to_double(t.a) - center, to_double(t.b) - center,
                                    to_double(t.c) - center};
    auto separated = [&](Vec3d axis) {
        const double a = dot(axis, p[0]), b = dot(axis, p[1]), c = dot(axis, p[2]);
        const double radius =
            half[0] * std::abs(axis.x) + half[1] * std::abs(axis.y) + half[2] * std::abs(axis.z);
        return std::min({a, b, c}) > radius || std::max({a, b, c}) < -radius;
    };
    const std::array<Vec3d, 3> units = {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::array<Vec3d, 3> edges = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    if (separated(cross(edges[0], edges[1]))) return false;
    for (Vec3d unit : units) {
        if (separated(unit)) return false;
        for (Vec3d edge : edges) {
            if (separated(cross(unit, edge))) return false;
        }
    }
    return true;
}

struct DoubleHit {
    bool inside;           ///< the ray's line meets the triangle
    double t, v, w;        ///< where, and the weights of corners b and c
    double edge_distance;  ///< how far the smallest weight is from 0
    double facing;         ///< cosine between ray and normal, times the triangle's area; absolute
};

inline DoubleHit intersect_exactly(const shared::Triangle& t, vec3 origin, vec3 direction) {
    const Vec3d d = to_double(direction);
    const Vec3d ab = to_double(t.b) - to_double(t.a), ac = to_double(t.c) - to_double(t.a);
    const Vec3d from_a = to_double(origin) - to_double(t.a);
    const Vec3d p = cross(d, ac), q = cross(from_a, ab);
    const double determinant = dot(ab, p);
    DoubleHit hit{};
    hit.v = dot(from_a, p) / determinant;
    hit.w = dot(d, q) / determinant;
    hit.t = dot(ac, q) / determinant;
    const double smallest = std::min({1 - hit.v - hit.w, hit.v, hit.w});
    hit.inside = smallest >= 0;
    hit.edge_distance = std::abs(smallest);
    hit.facing = std::abs(determinant);
    return hit;
}

inline vec3 random_vector(Pcg32& random, float low, float high) {
    const float x = random.uniform(), y = random.uniform(), z = random.uniform();
    return vec3{low, low, low} + vec3{x, y, z} * (high - low);
}

}  // namespace aglow::accel::gpu
