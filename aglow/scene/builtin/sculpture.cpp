// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/builtin/scenes.h"
#include "aglow/shared/noise.h"

#include <array>
#include <cmath>
#include <string>

namespace aglow::builtin {
namespace {

constexpr float kHeight = 0.5f;  // m, about; of the sculpture

/// The faces of an octahedron whose edges have `n` segments: vertices row by row, unit directions.
Shape octahedral_sphere(uint32_t n) {
    // Rows of the upper half count 1, 4, 8, .. 4n vertices, those of the lower half back to 1.
    Shape shape;
    std::vector<uint32_t> first(2 * n + 2);
    const auto in_row = [&](uint32_t row) {
        const uint32_t steps = row <= n ? row : 2 * n - row;
        return steps == 0 ? 1u : 4 * steps;
    };
    for (uint32_t row = 0; row <= 2 * n; ++row) {
        first[row] = static_cast<uint32_t>(shape.positions.size());
        const uint32_t steps = row <= n ? row : 2 * n - row;
        const float y = 1 - static_cast<float>(row) / static_cast<float>(n);
        for (uint32_t i = 0; i < in_row(row); ++i) {
            const uint32_t quarter = steps == 0 ? 0 : i / steps;
            const float along =
                steps == 0 ? 0 : static_cast<float>(i - quarter * steps) / static_cast<float>(n);
            const float rest = static_cast<float>(steps) / static_cast<float>(n) - along;
            constexpr std::array<vec2, 5> kCorners = {vec2{1, 0}, vec2{0, -1}, vec2{-1, 0},
                                                      vec2{0, 1}, vec2{1, 0}};
            const vec2 at = kCorners[quarter] * rest + kCorners[quarter + 1] * along;
            shape.positions.push_back(normalize(vec3{at.x, y, at.y}));
        }
    }
    const auto at = [&](uint32_t row, uint32_t i) { return first[row] + i % in_row(row); };
    for (uint32_t row = 0; row < n; ++row)
        for (uint32_t quarter = 0; quarter < 4; ++quarter)
            for (uint32_t i = 0; i <= row; ++i) {
                const uint32_t above = quarter * row + i, below = quarter * (row + 1) + i;
                const uint32_t mirror = 2 * n - row;  // the same in the lower half, turned over
                shape.triangles.push_back(
                    {at(row, above), at(row + 1, below), at(row + 1, below + 1)});
                shape.triangles.push_back(
                    {at(mirror, above), at(mirror - 1, below + 1), at(mirror - 1, below)});
                if (i == row) continue;
                shape.triangles.push_back(
                    {at(row, above), at(row + 1, below + 1), at(row, above + 1)});
                shape.triangles.push_back(
                    {at(mirror, above), at(mirror, above + 1), at(mirror - 1, below + 1)});
            }
    return shape;
}

/// A bulge of the body: how far it reaches out, and how pointed it is.
struct Lobe {
    vec3 direction;
    float reach, sharpness;
};

constexpr std::array kLobes = {
    Lobe{{0.3f, 0.9f, 0.3f}, 0.75f, 5},     // head
    Lobe{{-0.8f, 0.25f, 0.5f}, 0.5f, 9},    // arms
    Lobe{{0.9f, 0.1f, -0.35f}, 0.55f, 8},   //
    Lobe{{-0.45f, -0.8f, -0.4f}, 0.6f, 6},  // feet
    Lobe{{0.5f, -0.8f, 0.35f}, 0.6f, 6},    //
    Lobe{{0.1f, 0.2f, -0.95f}, 0.35f, 4},   // back
};

/// Lobes blended over a ball, with noise of eight octaves, then twisted about the upright.
vec3 sculpted(vec3 direction) {
    float reach = 0.45f;
    for (const Lobe& lobe : kLobes)
        reach +=
            lobe.reach * std::exp(lobe.sharpness * (dot(direction, normalize(lobe.direction)) - 1));
    const vec3 body = direction * reach;
    constexpr uint32_t kOctaves = 8, kSeed = 20;
    const float rough = shared::fbm(body * 2.2f, kOctaves, 2.0f, 0.48f, kSeed).value;
    const vec3 p = direction * (reach * (1 + 0.16f * rough));
    const float turn = 0.9f * p.y, c = std::cos(turn), s = std::sin(turn);
    return vec3{c * p.x + s * p.z, p.y, c * p.z - s * p.x} * (kHeight / 2);
}

}  // namespace

Scene sculpture(int64_t triangle_count) {
    SceneBuilder scene("sculpture:" + std::to_string(triangle_count));
    const double segments = std::floor(std::sqrt(static_cast<double>(triangle_count) / 8));
    Shape shape = octahedral_sphere(std::max(1u, static_cast<uint32_t>(segments)));
    for (vec3& p : shape.positions) p = sculpted(p);
    set_smooth_normals(shape);
    scene.add("sculpture", shape, scene.diffuse("stone", {0.62f, 0.58f, 0.52f}));
    scene.look({0.45f, 0.3f, 0.95f}, {0, 0, 0}, 32);
    Light sun;
    sun.name = "sun";
    sun.kind = LightKind::directional;
    sun.intensity = {3000, 3000, 3000};
    scene.add_directional(sun, 140, 40);
    return scene.take();
}

}  // namespace aglow::builtin
