// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/rays.h"

#include "aglow/core/parallel.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <memory>

using namespace aglow;

namespace {

constexpr int kMap = 8;  // texels of the lightmap's side
constexpr RaysOptions kMatte{.reflections = 0};

/// The square [-1, 1]^2 in the plane z = 0 that faces +Z, its lightmap over the whole atlas.
Scene square() {
    Primitive p;
    p.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    p.normals.assign(4, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.material = 0;
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.materials[0].base_color = {0.5f, 0.25f, 0.125f, 1};
    scene.meshes.resize(1);
    scene.meshes[0].primitives.push_back(std::move(p));
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    return scene;
}

struct Stage {
    explicit Stage(Scene s)
        : scene(std::move(s)), surfaces(pose(scene)), rays(trace(scene, surfaces)) {
        for (vec3 p : surfaces.positions)
            surfaces.lightmap_uvs.push_back(vec2{p.x + 1, p.y + 1} * (kMap / 2.0f));
    }
    static RayScene trace(const Scene& scene, const Surfaces& surfaces) {
        return RayScene::create(scene, surfaces).value();
    }
    Image image(const View& view, const Image& irradiance,
                const RaysOptions& options = kMatte) const {
        return render_rays({scene, surfaces, rays}, view, irradiance, options).value();
    }

    Scene scene;
    Surfaces surfaces;
    RayScene rays;
};

/// An orthographic view of [-half, half]^2 from (0, 0, z) along -Z, or along +Z from behind.
View view_from(float z, float half, int size) {
    View view{.to_world = translation({0, 0, z}),
              .perspective = false,
              .half_width = half,
              .half_height = half,
              .width = size,
              .height = size};
    if (z < 0) view.to_world.m = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, z, 1};
    return view;
}

/// E = 100 (x + 2), linear over the square, so that bilinear look-ups reproduce it inside.
Image ramp() {
    Image image(kMap, kMap);
    for (int y = 0; y < kMap; ++y)
        for (int x = 0; x < kMap; ++x) {
            const float at = (static_cast<float>(x) + 0.5f) / (kMap / 2.0f) - 1;
            image.at(x, y) = vec3{1, 1, 1} * (100 * (at + 2));
        }
    return image;
}

Image constant(float lux) {
    Image image(kMap, kMap);
    for (vec3& p : image.pixels) p = {lux, lux, lux};
    return image;
}

}  // namespace

TEST_CASE("a lit surface has the luminance albedo / pi * E") {
    const Stage stage(square());
    const Image image = stage.image(view_from(3, 0.5f, 8), ramp());
    for (int x = 0; x < 8; ++x) {
        const float at = (static_cast<float>(x) + 0.5f) / 8 - 0.5f;
        const float E = 100 * (at + 2);
        CHECK(image.at(x, 3).x == doctest::Approx(0.5f / kPi * E).epsilon(0.005));
        CHECK(image.at(x, 3).y == doctest::Approx(0.25f / kPi * E).epsilon(0.005));
        CHECK(image.at(x, 3).z == doctest::Approx(0.125f / kPi * E).epsilon(0.005));
    }
}

TEST_CASE("emission is added on the front, and on the back of double-sided materials") {
    Scene scene = square();
    scene.materials[0].emission = {7, 7, 7};
    const float reflected = 0.5f / kPi * 10;
    const auto red = [&](float z) {
        return Stage(scene).image(view_from(z, 0.5f, 1), constant(10)).pixels[0].x;
    };
    CHECK(red(2) == doctest::Approx(reflected + 7));
    CHECK(red(-2) == doctest::Approx(reflected));
    scene.materials[0].double_sided = true;
    CHECK(red(-2) == doctest::Approx(reflected + 7));
}

TEST_CASE("metals show their base colour, unlit materials their own at the reference white") {
    Scene scene = square();
    scene.materials[0].metallic = 1;
    const View view = view_from(2, 0.5f, 1);
    CHECK(Stage(scene).image(view, constant(10)).pixels[0].x == doctest::Approx(0.5f / kPi * 10));
    scene.materials[0].unlit = true;
    CHECK(Stage(scene).image(view, constant(10)).pixels[0].y == doctest::Approx(25));
}

TEST_CASE("misses show the sky: north in the middle, east to the right, up on top") {
    Scene scene = square();
    auto sky = std::make_shared<Image>(8, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) sky->at(x, y) = {float(x), float(y), 1};
    scene.sky = Sky{{1, 1, 2}, sky};
    const Stage stage(std::move(scene));
    const auto looking = [&](vec3 direction) {
        View view;
        view.half_width = view.half_height = 1e-4f;
        view.width = view.height = 1;
        const Frame frame(-direction);
        view.to_world.m = {frame.tangent.x,
                           frame.tangent.y,
                           frame.tangent.z,
                           0,
                           frame.bitangent.x,
                           frame.bitangent.y,
                           frame.bitangent.z,
                           0,
                           -direction.x,
                           -direction.y,
                           -direction.z,
                           0,
                           0,
                           0,
                           5,
                           1};
        return stage.image(view, constant(0), {.samples = 1, .reflections = 0}).pixels[0];
    };
    // The middle of pixel (column, row) is at azimuth (column + 0.5) / 8 turns from the south.
    const auto direction = [](float column, float row) {
        const float azimuth = ((column + 0.5f) / 8 - 0.5f) * 2 * kPi;
        const float polar = (row + 0.5f) / 4 * kPi;
        return vec3{std::sin(polar) * std::sin(azimuth), std::cos(polar),
                    -std::sin(polar) * std::cos(azimuth)};
    };
    for (int row : {0, 1, 3})
        for (int column : {0, 3, 5, 7}) {
            const vec3 c = looking(direction(float(column), float(row)));
            CAPTURE(row);
            CAPTURE(column);
            CHECK(std::abs(c.x - static_cast<float>(column)) < 0.01f);
            CHECK(std::abs(c.y - static_cast<float>(row)) < 0.01f);
            CHECK(c.z == doctest::Approx(2));
        }
    CHECK(looking(direction(3.5f, 1)).x == doctest::Approx(3.5).epsilon(1e-3));
}

TEST_CASE("an edge that halves a pixel halves its luminance") {
    // Pixels are 0.25 wide; the square's edge at x = 1 runs through the middle of the last column.
    const Stage stage(square());
    const Image image =
        stage.image(view_from(2, 1.125f, 9), constant(100), {.samples = 1024, .reflections = 0});
    const double full = 0.5 / 3.14159265 * 100;
    CHECK(image.at(8, 4).x == doctest::Approx(full / 2).epsilon(0.02));
    CHECK(image.at(0, 4).x == doctest::Approx(full / 2).epsilon(0.02));
    CHECK(image.at(4, 4).x == doctest::Approx(full).epsilon(1e-4));
}

TEST_CASE("the view of the illuminance is E itself, and nothing where there is no surface") {
    const Stage stage(square());
    const View view = view_from(2, 2, 16);
    const auto lux = render_illuminance(stage.surfaces, stage.rays, view, ramp());
    REQUIRE(lux);
    REQUIRE(lux->size() == 256);
    for (size_t x = 0; x < 16; ++x) {
        const float at = (static_cast<float>(x) + 0.5f) / 4 - 2;
        const float value = (*lux)[8 * 16 + x];
        CAPTURE(at);
        if (std::abs(at) > 1)
            CHECK(std::isnan(value));
        else if (std::abs(at) < 0.8f)
            CHECK(value == doctest::Approx(100 * (at + 2)).epsilon(1e-3));
    }
}

TEST_CASE("a picture has the same bits for one thread and for two") {
    const Stage stage(square());
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return stage
            .image(view_from(2, 1.3f, 40), ramp(), {.samples = 5, .reflections = 0, .seed = 9})
            .pixels;
    };
    CHECK(run(1) == run(2));
}

TEST_CASE("missing lightmap coordinates, no samples and interruption are errors") {
    Stage stage(square());
    const View view = view_from(2, 1, 4);
    const auto code = [&](const RaysOptions& options, const Monitor& monitor = {}) {
        return render_rays({stage.scene, stage.surfaces, stage.rays}, view, constant(1), options,
                           monitor)
            .error()
            .code;
    };
    CHECK(code({.samples = 0}) == Errc::bad_argument);
    std::atomic<bool> cancel = true;
    CHECK(code({}, {.report = {}, .cancel = &cancel}) == Errc::cancelled);
    stage.surfaces.lightmap_uvs.clear();
    CHECK(code({}) == Errc::bad_argument);
}
