// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/testing/rays.h"

#include <cmath>
#include <string>
#include <vector>

namespace aglow::testing {

/// A mesh without holes, and a ball inside it.
struct ClosedMesh {
    std::string name;
    Surfaces surfaces;
    vec3 inside = {0, 0, 0};
    float radius = 0;  ///< of the ball
};

/// A grid of rows x columns cells that closes in both directions, at position(u, v), 0 <= u, v < 1.
template <class Position>
Surfaces wrapped_grid(uint32_t rows, uint32_t columns, Position position) {
    Surfaces surfaces;
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c)
            surfaces.positions.push_back(
                position(static_cast<float>(r) / static_cast<float>(rows),
                         static_cast<float>(c) / static_cast<float>(columns)));
    const auto at = [&](uint32_t r, uint32_t c) { return r % rows * columns + c % columns; };
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            surfaces.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
            surfaces.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
        }
    return surfaces;
}

/// A ring around `center` whose tube has the given radius, with waves on it.
inline Surfaces ring(vec3 center, float radius, float tube, float waves, uint32_t cells) {
    return wrapped_grid(2 * cells, cells, [=](float u, float v) {
        const float a = 2 * kPi * u, b = 2 * kPi * v;
        const float r = tube * (1 + waves * std::sin(7 * a + 3 * b));
        const float from_axis = radius + r * std::cos(b);
        return center + vec3{from_axis * std::cos(a), r * std::sin(b), from_axis * std::sin(a)};
    });
}

/// The box around (-1, -1, -1) and (1, 1, 1), `cells` squares along each edge, moved by `place`.
template <class Place>
Surfaces cube(uint32_t cells, Place place) {
    Surfaces surfaces;
    for (uint32_t face = 0; face < 6; ++face) {
        const auto first = static_cast<uint32_t>(surfaces.positions.size());
        for (uint32_t i = 0; i <= cells; ++i)
            for (uint32_t j = 0; j <= cells; ++j) {
                const auto coordinate = [&](uint32_t k) {
                    return 2 * static_cast<float>(k) / static_cast<float>(cells) - 1;
                };
                const float s = face % 2 == 0 ? 1.0f : -1.0f, a = coordinate(i), b = coordinate(j);
                surfaces.positions.push_back(place(face / 2 == 0   ? vec3{s, a, b}
                                                   : face / 2 == 1 ? vec3{a, s, b}
                                                                   : vec3{a, b, s}));
            }
        for (uint32_t i = 0; i < cells; ++i)
            for (uint32_t j = 0; j < cells; ++j) {
                const uint32_t at = first + i * (cells + 1) + j;
                surfaces.triangles.push_back({at, at + cells + 1, at + cells + 2});
                surfaces.triangles.push_back({at, at + cells + 2, at + 1});
            }
    }
    return surfaces;
}

inline std::vector<ClosedMesh> closed_meshes() {
    return {
        {"box", cube(1, [](vec3 p) { return p; }), {0, 0, 0}, 0.9f},
        {"sphere", cube(24, [](vec3 p) { return normalize(p); }), {0, 0, 0}, 0.8f},
        {"small sphere far from the origin",
         cube(16,
              [](vec3 p) {
                  return vec3{300, -200, 100} + normalize(p) * 0.5f;
              }),
         {300, -200, 100},
         0.4f},
        {"ring", ring({0, 0, 0}, 3, 1, 0.2f, 24), {3, 0, 0}, 0.5f},
    };
}

/// A third each in any direction (some along an axis), towards vertices and towards edges.
inline std::vector<Ray> rays_from_inside(const ClosedMesh& mesh, size_t count, uint64_t seed) {
    Pcg32 random(seed);
    const auto centered = [&] { return 2 * random.uniform() - 1; };
    const Surfaces& surfaces = mesh.surfaces;
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const vec3 offset{centered(), centered(), centered()};
        if (!(length(offset) < 1)) continue;
        const vec3 origin = mesh.inside + offset * mesh.radius;
        vec3 direction{centered(), centered(), centered()};
        const size_t kind = rays.size() % 3;
        if (kind == 0) {
            if (random.next() % 4 == 0) direction.x = 0;
            if (random.next() % 4 == 0) direction.y = 0;
        } else {
            const uint32_t t = random.next() % static_cast<uint32_t>(surfaces.triangles.size());
            const int corner = static_cast<int>(random.next() % 3);
            const float along = kind == 1 ? 0.0f : random.uniform();
            direction = shared::mix(surfaces.corner(t, corner),
                                    surfaces.corner(t, (corner + 1) % 3), along) -
                        origin;
        }
        if (!(length(direction) > 0)) continue;
        rays.push_back({origin, normalize(direction)});
    }
    return rays;
}

}  // namespace aglow::testing
