// SPDX-License-Identifier: Apache-2.0
// Pictures of engine `raster` of meshes that height maps displace.
#include "aglow/core/testing/demand.h"
#include "aglow/render/testing/raster.h"
#include "aglow/scene/image_file.h"
#include "aglow/vk/testing/test_device.h"
#include "tests/temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <optional>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

/// Writes how far the faces of an octahedron are from the ball around it, for a map of which they
/// all cover the same triangle.
void write_ball(const std::filesystem::path& file) {
    constexpr int kSize = 128;
    Image image(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const float v = ((static_cast<float>(x) + 0.5f) / kSize - 0.1f) / 0.8f;
            const float w = ((static_cast<float>(y) + 0.5f) / kSize - 0.1f) / 0.8f;
            image.at(x, y).x = 1 - length(vec3{1 - v - w, v, w});
        }
    REQUIRE(write_image(image, file));
}

/// An octahedron with the normals of the ball that its height map makes of it, in daylight.
struct Relief {
    Scene scene;

    explicit Relief(const std::filesystem::path& file) : scene(octahedron(false)) {
        scene.materials[0] = diffuse({0.8f, 0.8f, 0.8f});
        Primitive& p = primitive();
        p.texcoords.emplace_back();
        for (size_t i = 0; i < p.triangles.size(); ++i)
            for (const vec2 uv : {vec2{0.1f, 0.1f}, vec2{0.9f, 0.1f}, vec2{0.1f, 0.9f}})
                p.texcoords[0].push_back(uv);
        p.displacement = DisplacementRef{file, 0, 1, 0};
        add_sun(scene);
    }
    Primitive& primitive() { return scene.meshes[0].primitives[0]; }
};

DrawnFrame drawn(const Gpu& gpu, const Scene& scene, const View& view, Refinement refinement) {
    RasterOptions options;
    options.refinement = refinement;
    const auto renderer = demand(make_raster_frame_renderer(gpu, {scene}, options));
    return demand(renderer->draw(-1, view, {}));
}

constexpr Refinement kUniform{Refinement::Kind::pn, 5};

Refinement automatic(float tolerance) {
    Refinement refinement;
    refinement.kind = Refinement::Kind::automatic;
    refinement.tolerance = tolerance;
    return refinement;
}

/// A ball of this radius about the origin in the light of Relief, seen from above: 1000 lux times
/// the sine of the sun's height, at 0.8 / pi.
Image ball_from_above(float radius, float half, int size) {
    constexpr int n = 8;
    Image image(size, size);
    for (int y = 0; y < size * n; ++y)
        for (int x = 0; x < size * n; ++x) {
            const vec2 at = position_of(x, y, half, size * n);
            const float square = (at.x * at.x + at.y * at.y) / (radius * radius);
            if (square < 1)
                image.at(x / n, y / n) +=
                    vec3{1, 1, 1} * (1000 * 0.8f / kPi * std::sqrt(1 - square) / (n * n));
        }
    return image;
}

}  // namespace

TEST_CASE("flat faces that a map raises to a ball look like the ball, scaled and mirrored too") {
    vk::TestDevice device;
    if (!device) return;
    const testing::TemporaryFolder folder;
    write_ball(folder.path / "ball.exr");
    for (const vec3 scale : {vec3{1, 1, 1}, vec3{0.5f, 0.5f, 0.5f}, vec3{-1, 1, 1}}) {
        CAPTURE(scale.x);
        Relief relief(folder.path / "ball.exr");
        relief.scene.nodes[0].scale = scale;
        const float radius = scale.y;
        const View view = from_above(4, 1.25f * radius, 96);
        const Image ball = ball_from_above(radius, 1.25f * radius, 96);
        const auto off = [&](Refinement refinement) {
            const DrawnFrame frame = drawn(device.gpu(), relief.scene, view, refinement);
            return demand(difference(frame.luminance, ball)).relative_rmse;
        };
        CHECK(off(kUniform) < 0.02);
        CHECK(off({Refinement::Kind::pn, 3}) < 0.07);
        CHECK(off(automatic(0.25f)) < 0.03);
        CHECK(off(automatic(0.25f)) < off(automatic(4)));
        // Unrefined, there is no displacement.
        CHECK(off({}) > 0.2);
    }
}

TEST_CASE("levels of displaced edges keep the tolerance with fewer triangles than a uniform one") {
    vk::TestDevice device;
    if (!device) return;
    const testing::TemporaryFolder folder;
    write_ball(folder.path / "ball.exr");
    const Relief relief(folder.path / "ball.exr");
    uint64_t last = 0;
    for (const float half : {40.0f, 6.0f, 1.25f}) {
        const View view = from_above(4, half, 128);
        const uint64_t triangles =
            drawn(device.gpu(), relief.scene, view, automatic(0.5f)).triangles;
        CHECK(triangles > last);
        CHECK(triangles < 8 * 1024);
        last = triangles;
    }
}

TEST_CASE("meshes have height maps of their own, beside curved ones that have none") {
    vk::TestDevice device;
    if (!device) return;
    const testing::TemporaryFolder folder;
    write_ball(folder.path / "ball.exr");
    Relief relief(folder.path / "ball.exr");
    Scene& scene = relief.scene;
    // The second is not displaced; the third stays flat, lowered by a tenth of its scale.
    for (int i = 0; i < 2; ++i) {
        scene.meshes.push_back(scene.meshes[0]);
        scene.nodes.push_back(scene.nodes[0]);
        scene.nodes.back().mesh = i + 1;
        scene.nodes.back().translation = {3.0f * static_cast<float>(i + 1), 0, 0};
    }
    scene.meshes[1].primitives[0].displacement.reset();
    scene.meshes[2].primitives[0].displacement->scale = 0;
    scene.meshes[2].primitives[0].displacement->bias = -0.1f;
    for (const Refinement refinement : {kUniform, automatic(0.1f)}) {
        const auto covered = [&](float x) {
            View view = from_above(4, 1.25f, 64);
            view.to_world = translation({x, 0, 4});
            const Image image = drawn(device.gpu(), scene, view, refinement).luminance;
            double count = 0;
            for (const vec3 pixel : image.pixels) count += pixel.x > 0 ? 1 : 0;
            return count / 4096 * 6.25;
        };
        CHECK(covered(0) == doctest::Approx(3.1416).epsilon(0.05));
        CHECK(covered(3) == doctest::Approx(41.0 / 15).epsilon(0.05));  // see refined_test.cpp
        CHECK(covered(6) == doctest::Approx(2 * 0.9 * 0.9).epsilon(0.12));
    }
}

TEST_CASE("maps that are not there, or several of one mesh, are errors") {
    vk::TestDevice device;
    if (!device) return;
    const testing::TemporaryFolder folder;
    write_ball(folder.path / "ball.exr");
    Relief relief(folder.path / "ball.exr");
    RasterOptions options;
    options.refinement = kUniform;
    const auto code = [&] {
        const auto made = make_raster_frame_renderer(device.gpu(), {relief.scene}, options);
        return made ? std::optional<Errc>() : made.error().code;
    };
    Primitive second = relief.primitive();
    relief.scene.meshes[0].primitives.push_back(second);
    relief.primitive().displacement->scale = 2;
    CHECK(code() == Errc::unsupported);
    relief.scene.meshes[0].primitives.pop_back();
    relief.primitive().displacement->file = folder.path / "none.exr";
    CHECK(code() == Errc::unreadable);
}
