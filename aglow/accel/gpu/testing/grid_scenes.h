// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/testing/grid_reference.h"
#include "aglow/shared/ray.h"

#include <cstdint>
#include <vector>

namespace aglow::accel::gpu {

using Triangles = std::vector<shared::Triangle>;

/// Triangles of about this edge length all over the unit cube.
inline Triangles soup(uint32_t count, float edge, uint64_t seed) {
    Pcg32 random(seed);
    Triangles triangles;
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 at = random_vector(random, 0, 1);
        triangles.push_back(
            {at, at + random_vector(random, -edge, edge), at + random_vector(random, -edge, edge)});
    }
    return triangles;
}

/// A closed sphere of 2 * columns * (rows - 1) triangles.
inline Triangles sphere(vec3 center, float radius, uint32_t columns, uint32_t rows) {
    auto at = [&](uint32_t column, uint32_t row) {
        const float phi =
            2 * kPi * static_cast<float>(column % columns) / static_cast<float>(columns);
        const float theta = kPi * static_cast<float>(row) / static_cast<float>(rows);
        if (row == 0) return center + vec3{0, radius, 0};
        if (row == rows) return center - vec3{0, radius, 0};
        return center + vec3{std::sin(theta) * std::cos(phi), std::cos(theta),
                             std::sin(theta) * std::sin(phi)} *
                            radius;
    };
    Triangles triangles;
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const vec3 a = at(column, row), b = at(column + 1, row);
            const vec3 c = at(column + 1, row + 1), d = at(column, row + 1);
            if (row > 0) triangles.push_back({a, b, c});
            if (row + 1 < rows) triangles.push_back({a, c, d});
        }
    }
    return triangles;
}

/// The cube from `low` to `high`.
inline Triangles cube(float low, float high) {
    auto corner = [&](int i) {
        return vec3{i & 1 ? high : low, i & 2 ? high : low, i & 4 ? high : low};
    };
    Triangles triangles;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
        for (int side : {0, 1 << axis}) {
            triangles.push_back({corner(side), corner(side + u), corner(side + u + v)});
            triangles.push_back({corner(side), corner(side + u + v), corner(side + v)});
        }
    }
    return triangles;
}

/// A ground of two triangles, 100 m wide, with trees of tiny ones on it: what a single grid is bad
/// at.
inline Triangles forest(uint32_t trees, uint32_t leaves, uint64_t seed) {
    Pcg32 random(seed);
    Triangles triangles = {{{-50, 0, -50}, {50, 0, -50}, {50, 0, 50}},
                           {{-50, 0, -50}, {50, 0, 50}, {-50, 0, 50}}};
    for (uint32_t tree = 0; tree < trees; ++tree) {
        const vec3 root = {random.uniform() * 90 - 45, 0, random.uniform() * 90 - 45};
        const vec3 crown = root + vec3{0, 2 + random.uniform(), 0};
        triangles.push_back({root, root + vec3{0.1f, 0, 0}, crown});
        for (uint32_t leaf = 0; leaf < leaves; ++leaf) {
            const vec3 in_ball = random_vector(random, -1, 1);
            const vec3 at = crown + in_ball * (1 / std::max(1.0f, shared::length(in_ball)));
            triangles.push_back({at, at + random_vector(random, -0.03f, 0.03f),
                                 at + random_vector(random, -0.03f, 0.03f)});
        }
    }
    return triangles;
}

inline Triangles joined(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline Triangles moved(Triangles triangles, vec3 by) {
    for (shared::Triangle& t : triangles) t = {t.a + by, t.b + by, t.c + by};
    return triangles;
}

/// A ray from somewhere in the box through a point somewhere in it.
inline shared::RayQuery random_ray(Pcg32& random, vec3 lower, vec3 upper) {
    auto point = [&] { return lower + (upper - lower) * random_vector(random, 0, 1); };
    const vec3 origin = point();
    return {origin, 0, point() - origin, kInfinity};
}

}  // namespace aglow::accel::gpu
