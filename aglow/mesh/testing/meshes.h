// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

/// Meshes and small scenes for the tests of this stage.
namespace aglow::mesh::testing {

/// A primitive with flat placeholder normals.
inline Primitive primitive(std::vector<vec3> positions, std::vector<uvec3> triangles) {
    Primitive p;
    p.normals.assign(positions.size(), vec3{0, 0, 1});
    p.positions = std::move(positions);
    p.triangles = std::move(triangles);
    return p;
}

/// The unit square in the plane z = 0, seen from +Z.
inline Primitive unit_quad() {
    return primitive({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

/// A box from the origin with outward faces; vertices shared by faces.
inline Primitive box(vec3 size) {
    std::vector<vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(
            vec3{size.x * float(i & 1), size.y * float(i >> 1 & 1), size.z * float(i >> 2)});
    return primitive(corners, {{0, 2, 1},
                               {1, 2, 3},
                               {4, 5, 6},
                               {5, 7, 6},
                               {0, 1, 4},
                               {1, 5, 4},
                               {2, 6, 3},
                               {3, 6, 7},
                               {0, 4, 2},
                               {2, 4, 6},
                               {1, 3, 5},
                               {3, 7, 5}});
}

/// A grid of columns x rows quads over a map of the unit square; ends wrap where asked.
template <class Map>
Primitive sheet(uint32_t columns, uint32_t rows, Map map) {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x)
            positions.push_back(map(float(x) / float(columns), float(y) / float(rows)));
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
            triangles.push_back({a, a + 1, b});
            triangles.push_back({a + 1, b + 1, b});
        }
    return primitive(positions, triangles);
}

inline Primitive torus(uint32_t columns, uint32_t rows, float major, float minor) {
    return sheet(columns, rows, [=](float u, float v) {
        // Whole turns are reduced first, so that both ends have the same bits and are welded.
        const float a = 2 * kPi * (u == 1 ? 0 : u), b = 2 * kPi * (v == 1 ? 0 : v);
        const float r = major + minor * std::cos(b);
        return vec3{r * std::cos(a), minor * std::sin(b), -r * std::sin(a)};
    });
}

inline Primitive mobius_strip(uint32_t columns) {
    return sheet(columns, 2, [](float u, float v) {
        const float a = 2 * kPi * u, w = (v - 0.5f) * 0.8f;
        const float r = 1 + w * std::cos(a / 2);
        return vec3{r * std::cos(a), r * std::sin(a), w * std::sin(a / 2)};
    });
}

/// A sphere of radius 1 by latitude and longitude.
inline Primitive sphere(uint32_t columns, uint32_t rows) {
    return sheet(columns, rows, [](float u, float v) {
        const float a = 2 * kPi * (u == 1 ? 0 : u), b = kPi * v;
        const float r = v == 0 || v == 1 ? 0 : std::sin(b);
        return vec3{r * std::cos(a), -std::cos(b), -r * std::sin(a)};
    });
}

/// Pages that all meet in one edge: no manifold.
inline Primitive book(uint32_t pages) {
    std::vector<vec3> positions = {{0, 0, 0}, {0, 1, 0}};
    std::vector<uvec3> triangles;
    for (uint32_t p = 0; p < pages; ++p) {
        const float a = 2 * kPi * float(p) / float(pages);
        const auto first = static_cast<uint32_t>(positions.size());
        positions.push_back({std::cos(a), 0, std::sin(a)});
        positions.push_back({std::cos(a), 1, std::sin(a)});
        triangles.push_back({0, first, 1});
        triangles.push_back({first, first + 1, 1});
    }
    return primitive(positions, triangles);
}

/// A scene of one mesh, placed once for each transform.
inline Scene scene_of(std::vector<Primitive> primitives,
                      const std::vector<mat4>& transforms = {{}}) {
    Scene scene;
    scene.meshes.push_back({"mesh", std::move(primitives), {}});
    for (const mat4& transform : transforms) {
        Node node;
        node.mesh = 0;
        node.has_matrix = true;
        node.matrix = transform;
        scene.nodes.push_back(node);
    }
    return scene;
}

inline mat4 scaling(vec3 s) { return compose({0, 0, 0}, {0, 0, 0, 1}, s); }

}  // namespace aglow::mesh::testing
