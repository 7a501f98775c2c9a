// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/builtin/scenes.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace aglow::builtin {
namespace {

constexpr int64_t kRoomTriangles = 12;
constexpr int64_t kSmallestSphere = 4;  // a tetrahedron

/// A unit direction's distance from the sphere's centre: bumps of one tenth of its radius.
vec3 bumpy(vec3 direction) {
    const vec3 d = normalize(direction);
    const float bump = std::sin(9 * d.x) * std::sin(9 * d.y + 1) * std::sin(9 * d.z + 2);
    return d * (1 + 0.1f * bump);
}

/// Rings of `slices` vertices between two poles: 2 * slices * rings triangles.
Shape ringed_sphere(int64_t slices, int64_t rings) {
    Shape shape;
    shape.positions.push_back(bumpy({0, -1, 0}));
    for (int64_t j = 0; j < rings; ++j) {
        const float polar = kPi * static_cast<float>(j + 1) / static_cast<float>(rings + 1);
        for (int64_t i = 0; i < slices; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(slices);
            shape.positions.push_back(bumpy({std::sin(polar) * std::cos(angle), -std::cos(polar),
                                             -std::sin(polar) * std::sin(angle)}));
        }
    }
    shape.positions.push_back(bumpy({0, 1, 0}));
    const auto top = static_cast<uint32_t>(shape.positions.size() - 1);
    const auto at = [&](int64_t i, int64_t j) {
        return static_cast<uint32_t>(1 + j * slices + i % slices);
    };
    for (int64_t i = 0; i < slices; ++i) {
        shape.triangles.push_back({0, at(i + 1, 0), at(i, 0)});
        for (int64_t j = 0; j + 1 < rings; ++j) {
            shape.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            shape.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        shape.triangles.push_back({top, at(i, rings - 1), at(i + 1, rings - 1)});
    }
    return shape;
}

Shape tetrahedron() {
    Shape shape;
    for (const vec3 corner : {vec3{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}})
        shape.positions.push_back(bumpy(corner));
    shape.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return shape;
}

/// Raises the middle of the first triangles, each of which becomes three: two more per step.
void split_triangles(Shape& shape, int64_t missing) {
    for (size_t i = 0; missing > 0; missing -= 2, ++i) {
        const uvec3 t = shape.triangles[i];
        const auto middle = static_cast<uint32_t>(shape.positions.size());
        shape.positions.push_back(
            bumpy(shape.positions[t.x] + shape.positions[t.y] + shape.positions[t.z]));
        shape.triangles[i] = {t.x, t.y, middle};
        shape.triangles.push_back({t.y, t.z, middle});
        shape.triangles.push_back({t.z, t.x, middle});
    }
}

/// Closed bumpy sphere of exactly `triangle_count` triangles, an even number of at least 4.
Shape bumpy_sphere(int64_t triangle_count) {
    // Slices = 2 * rings makes the triangles near square: 4 * rings^2 of them.
    const auto rings = static_cast<int64_t>(std::sqrt(static_cast<double>(triangle_count) / 4));
    Shape shape = rings < 2 ? tetrahedron() : ringed_sphere(triangle_count / (2 * rings), rings);
    split_triangles(shape, triangle_count - static_cast<int64_t>(shape.triangles.size()));
    set_smooth_normals(shape);
    return shape;
}

void add_room(SceneBuilder& scene, float half, float height) {
    const int grey = scene.diffuse("grey", {0.6f, 0.6f, 0.6f});
    const int panel = scene.luminous("luminous ceiling", {0.7f, 0.7f, 0.7f}, {1000, 1000, 1000});
    const auto corner = [&](float x, float y, float z) {
        return vec3{x * half, y * height, z * half};
    };
    const auto side = [&](float x0, float z0, float x1, float z1) {
        return quad(corner(x0, 0, z0), corner(x1, 0, z1), corner(x1, 1, z1), corner(x0, 1, z0));
    };
    Shape walls = quad(corner(-1, 0, 1), corner(1, 0, 1), corner(1, 0, -1), corner(-1, 0, -1));
    walls.append(side(-1, -1, 1, -1));
    walls.append(side(1, -1, 1, 1));
    walls.append(side(1, 1, -1, 1));
    walls.append(side(-1, 1, -1, -1));
    const Shape ceiling =
        quad(corner(-1, 1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(-1, 1, 1));
    scene.add("room", {{walls, grey}, {ceiling, panel}});
}

}  // namespace

Scene stress(int64_t triangle_count) {
    SceneBuilder scene("stress:" + std::to_string(triangle_count));
    constexpr float kHalf = 5, kHeight = 4;  // metres
    add_room(scene, kHalf, kHeight);
    scene.look({-4.5f, 2.8f, 4.5f}, {0, 0.8f, 0}, 55);
    const int clay = scene.diffuse("clay", {0.65f, 0.5f, 0.4f});

    int64_t left = (triangle_count - kRoomTriangles) / 2 * 2;  // closed surfaces have even counts
    if (left < kSmallestSphere) return scene.take();
    const auto sphere_count =
        std::max<int64_t>(1, static_cast<int64_t>(std::cbrt(static_cast<double>(left))));
    const auto per_row =
        static_cast<int64_t>(std::ceil(std::sqrt(static_cast<double>(sphere_count))));
    const float spacing = 2 * kHalf / static_cast<float>(per_row);
    for (int64_t i = 0; i < sphere_count; ++i) {
        const int64_t share = left / (sphere_count - i) / 2 * 2;
        left -= share;
        const float radius = 0.4f * std::min(spacing, 2.0f);
        const vec3 center{(static_cast<float>(i % per_row) + 0.5f) * spacing - kHalf, 1.2f * radius,
                          (static_cast<float>(i / per_row) + 0.5f) * spacing - kHalf};
        const Shape sphere = bumpy_sphere(share).scaled({radius, radius, radius}).moved(center);
        scene.add("sphere " + std::to_string(i), sphere, clay);
    }
    return scene.take();
}

}  // namespace aglow::builtin
