// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of refining whole ones.
#pragma once
#include "aglow/mesh/surfaces.h"
#include "aglow/refine/refine_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace aglow::refine::testing {

using Point = std::array<float, 3>;

inline Point point(vec3 p) { return {p.x, p.y, p.z}; }

/// A cube of two primitives, the top apart from the rest; every side has its own texture
/// coordinates and normals, as exporters write it.
inline Scene cube() {
    Scene scene;
    scene.name = "cube";
    Mesh mesh;
    mesh.primitives.resize(2);
    const auto add_side = [&](Primitive& p, vec3 n, vec3 u, vec3 v) {
        const auto first = static_cast<uint32_t>(p.positions.size());
        p.texcoords.resize(1);
        for (const vec2 at : {vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            p.positions.push_back(n + u * at.x + v * at.y);
            p.normals.push_back(n);
            p.texcoords[0].push_back({0.5f + 0.5f * at.x, 0.5f + 0.5f * at.y});
        }
        p.triangles.push_back({first, first + 1, first + 2});
        p.triangles.push_back({first, first + 2, first + 3});
    };
    const vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    add_side(mesh.primitives[0], x, y, z);
    add_side(mesh.primitives[0], x * -1.0f, z, y);
    add_side(mesh.primitives[0], y * -1.0f, x, z);
    add_side(mesh.primitives[0], z, x, y);
    add_side(mesh.primitives[0], z * -1.0f, y, x);
    add_side(mesh.primitives[1], y, z, x);
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

/// A convex drum: flat in the middle of its ends, bent where they meet the side.
inline Scene drum() {
    constexpr uint32_t kSides = 12;
    Scene scene;
    Primitive p;
    const auto add = [&](float radius, float height, vec2 normal, uint32_t sides) {
        for (uint32_t side = 0; side < sides; ++side) {
            const float a = 2 * kPi * static_cast<float>(side) / kSides;
            p.positions.push_back({radius * std::cos(a), height, -radius * std::sin(a)});
            p.normals.push_back(
                normalize(vec3{normal.x * std::cos(a), normal.y, -normal.x * std::sin(a)}));
            p.colors.push_back({0.5f + height, 0.5f, 0, 1});
        }
    };
    add(0, 0.5f, {0, 1}, 1);
    add(0.8f, 0.4f, {1, 1}, kSides);
    add(0.8f, -0.4f, {1, -1}, kSides);
    add(0, -0.5f, {0, -1}, 1);
    for (uint32_t side = 0; side < kSides; ++side) {
        const uint32_t a = 1 + side, b = 1 + (side + 1) % kSides;
        const uint32_t c = a + kSides, d = b + kSides;
        p.triangles.push_back({0, a, b});
        p.triangles.push_back({a, c, d});
        p.triangles.push_back({a, d, b});
        p.triangles.push_back({c, 1 + 2 * kSides, d});
    }
    scene.meshes.push_back({"drum", {std::move(p)}, {}});
    scene.nodes.emplace_back().mesh = 0;
    return scene;
}

inline Scene refined(const Scene& scene, const RefineOptions& options) {
    auto result = refine_scene(scene, options);
    REQUIRE_MESSAGE(result, (result ? "" : to_string(result.error())));
    return std::move(*result);
}

inline Scene refined(const Scene& scene, RefineScheme scheme, int level) {
    RefineOptions options;
    options.scheme = scheme;
    options.level = level;
    return refined(scene, options);
}

inline size_t triangle_count(const Scene& scene) {
    size_t count = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) count += p.triangles.size();
    return count;
}

/// Edges of a posed scene, by the bits of their ends, that not exactly two triangles have.
inline size_t open_edges(const Surfaces& surfaces) {
    std::map<std::pair<Point, Point>, int> uses;
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const Point a = point(surfaces.corner(t, i)),
                        b = point(surfaces.corner(t, (i + 1) % 3));
            if (a != b) ++uses[std::minmax(a, b)];
        }
    return static_cast<size_t>(
        std::ranges::count_if(uses, [](const auto& use) { return use.second % 2 != 0; }));
}

inline constexpr std::array kSchemes = {RefineScheme::loop, RefineScheme::catmull_clark,
                                        RefineScheme::pn, RefineScheme::tagged,
                                        RefineScheme::phong};

/// The unit square in the plane z = 0 of two triangles, without a scene's node.
inline Primitive square() {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    p.normals.assign(4, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    return p;
}

inline Scene scene_of(Primitive primitive) {
    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives.push_back(std::move(primitive));
    scene.nodes.emplace_back().mesh = 0;
    return scene;
}

}  // namespace aglow::refine::testing
