// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace aglow;
using namespace aglow::refine::testing;

TEST_CASE("a constant height moves every vertex by it, and no crack opens") {
    RefineOptions options;
    options.level = 2;
    const std::array heights = {0.5f, 0.5f, 0.5f, 0.5f};
    options.displacement = HeightDisplacement{make_height_map(heights, 2, 2), 0.2f, 0.05f};
    const Surfaces moved = pose(refined(cube(), options));
    options.displacement.reset();
    const Surfaces still = pose(refined(cube(), options));
    for (size_t v = 0; v < moved.positions.size(); ++v)
        CHECK(length(moved.positions[v] - still.positions[v]) ==
              doctest::Approx(0.15).epsilon(1e-4));
    CHECK(open_edges(moved) == 0);
}

TEST_CASE("texels of a height map are taken as coarse as the refined vertices are apart") {
    constexpr int kSize = 64, kLevel = 3, kSpan = kSize >> kLevel;  // texels between vertices
    std::vector<float> heights;
    for (int i = 0; i < kSize * kSize; ++i)
        heights.push_back(static_cast<float>(i * 7919 % 4093) / 4093);
    const Scene scene = scene_of(square());
    RefineOptions options;
    options.scheme = RefineScheme::flat;
    options.level = kLevel;
    options.displacement = HeightDisplacement{make_height_map(heights, kSize, kSize), 0.5f, 0.25f};
    const Primitive fine = refined(scene, options).meshes[0].primitives[0];
    CHECK(fine.positions.size() == 81);
    for (const vec3 at : fine.positions) {
        // Between four texels of the level: the mean of all that these are made of.
        const int x = static_cast<int>(std::lround(at.x * kSize)),
                  y = static_cast<int>(std::lround(at.y * kSize));
        double sum = 0;
        for (int j = y - kSpan; j < y + kSpan; ++j)
            for (int i = x - kSpan; i < x + kSpan; ++i)
                sum += double{heights[static_cast<size_t>((j + kSize) % kSize * kSize +
                                                          (i + kSize) % kSize)]};
        CHECK(double{at.z} ==
              doctest::Approx(0.25 + 0.5 * sum / (4 * kSpan * kSpan)).epsilon(1e-5));
    }
}

TEST_CASE("sides that meet at two degrees keep their normals where they are to part") {
    Primitive p;
    const float c = std::cos(2 * kPi / 180), s = std::sin(2 * kPi / 180);
    p.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, s}, {c, 1, s}};
    p.normals.assign(6, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    p.texcoords = {std::vector<vec2>(6, vec2{0, 0})};
    const Scene scene = scene_of(std::move(p));
    RefineOptions options;
    options.level = 2;
    options.control.crease_angle = 1 * kPi / 180;
    const HeightMap flat = make_height_map(std::array{1.0f}, 1, 1);
    for (const RefineScheme scheme : kSchemes)
        for (const bool displaced : {false, true}) {
            CAPTURE(static_cast<int>(scheme));
            CAPTURE(displaced);
            options.scheme = scheme;
            options.displacement.reset();
            if (displaced) options.displacement = HeightDisplacement{flat, 0, 0};
            const Primitive fine = refined(scene, options).meshes[0].primitives[0];
            for (const uvec3 t : fine.triangles)
                for (const uint32_t v : {t.x, t.y, t.z}) {
                    const vec3 middle =
                        fine.positions[t.x] + fine.positions[t.y] + fine.positions[t.z];
                    const vec3 side = middle.x < 0 ? vec3{0, 0, 1} : vec3{-s, 0, c};
                    CHECK(length(fine.normals[v] - side) < 1e-4f);
                }
        }
}

TEST_CASE("normals of displaced triangles count by their angles") {
    // A cube whose corners have four to six triangles, smooth at its corners.
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives)
        for (size_t v = 0; v < p.positions.size(); ++v) p.normals[v] = normalize(p.positions[v]);
    RefineOptions options;
    options.scheme = RefineScheme::flat;
    options.level = 1;
    options.displacement = HeightDisplacement{make_height_map(std::array{1.0f}, 1, 1), 0, 0};
    size_t corners = 0;
    const Scene fine = refined(scene, options);
    for (const Primitive& p : fine.meshes[0].primitives)
        for (size_t v = 0; v < p.positions.size(); ++v) {
            if (length(p.positions[v]) < 1.7f) continue;
            CHECK(length(p.normals[v] - normalize(p.positions[v])) < 1e-5f);
            ++corners;
        }
    CHECK(corners >= 8);
}

TEST_CASE("a height map that differs across seams does not open them") {
    RefineOptions options;
    options.level = 3;
    std::vector<float> heights;
    for (int i = 0; i < 64; ++i) heights.push_back(static_cast<float>(i * 37 % 64) / 64);
    options.displacement = HeightDisplacement{make_height_map(heights, 8, 8), 0.1f, 0};
    for (const RefineScheme scheme : kSchemes) {
        options.scheme = scheme;
        CHECK(open_edges(pose(refined(cube(), options))) == 0);
    }
}

TEST_CASE("a sine of place moves a plane as the sine says, and noise as the field says") {
    const vec3 wave{3, 0, -5};
    shared::Displacement sine{};
    sine.kind = shared::kSineDisplacement;
    sine.amplitude = 0.05f;
    sine.frequency = wave;
    shared::Displacement noise{};
    noise.kind = shared::kNoiseDisplacement;
    noise.amplitude = 0.1f;
    noise.frequency = {2, 2, 2};
    noise.octaves = 4;
    noise.lacunarity = 2;
    noise.gain = 0.5f;
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());  // the top alone: y = 1
    for (const RefineScheme scheme : kSchemes) {
        RefineOptions options;
        options.scheme = scheme;
        options.level = 5;
        options.field = sine;
        const Scene waves = refined(plane, options);
        for (const vec3 p : waves.meshes[0].primitives[0].positions)
            CHECK(double(p.y) ==
                  doctest::Approx(1 + 0.05 * std::sin(double(dot(wave, {p.x, 1, p.z})))));
        options.field = noise;
        const Scene rough = refined(plane, options);
        for (const vec3 p : rough.meshes[0].primitives[0].positions) {
            const float height = shared::fbm(vec3{p.x, 1, p.z} * 2, 4, 2, 0.5f, 0).value;
            CHECK(p.y == doctest::Approx(1 + 0.1f * height).epsilon(1e-5));
        }
        CHECK(open_edges(pose(refined(cube(), options))) == 0);
    }
}

TEST_CASE("a sine's normals are those of its slope") {
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());
    RefineOptions options;
    options.level = 7;
    options.field = shared::Displacement{};
    options.field->kind = shared::kSineDisplacement;
    options.field->amplitude = 0.1f;
    options.field->frequency = {4, 0, 0};
    const Scene fine = refined(plane, options);
    const Primitive& top = fine.meshes[0].primitives[0];
    for (size_t v = 0; v < top.positions.size(); ++v) {
        const vec3 p = top.positions[v];
        if (std::max(std::fabs(p.x), std::fabs(p.z)) > 0.99f) continue;  // one-sided at the rim
        const vec3 expected = normalize(vec3{-0.4f * std::cos(4 * p.x), 1, 0});
        CHECK(length(top.normals[v] - expected) < 2e-3f);
    }
}
