// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"

#include "aglow/render/testing/stage.h"

#include <atomic>
#include <cmath>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

constexpr RaysOptions kMatte{.samples = 1, .reflections = 0};
constexpr float kRho = 0.5f;

/// Moves a node along x from where it stands at rest, by `by` in one second.
void move_along_x(Scene& scene, int node, float by) {
    const vec3 rest = scene.nodes[static_cast<size_t>(node)].translation;
    AnimationChannel channel;
    channel.node = node;
    channel.times = {0, 1};
    channel.values = {rest.x, rest.y, rest.z, rest.x + by, rest.y, rest.z};
    scene.animations.push_back({"", {channel}});
}

float lux(const Image& image, int x, int y) { return image.at(x, y).x * kPi / kRho; }

}  // namespace

TEST_CASE("a point light that is not baked gives I cos / d^2") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 2);
    const float candela = 100;
    const vec3 lamp{0.3f, 0.2f, 1.5f};
    add_point_light(quads.scene, lamp, candela * 4 * kPi);
    const int size = 9;
    const Image image =
        picture(quads.scene, nullptr, from_above(3, 1, size), {.samples = 256, .reflections = 0});
    for (const int x : {0, 4, 7}) {
        const vec2 at = position_of(x, 4, 1, size);
        const vec3 to_light = lamp - vec3{at.x, at.y, 0};
        const float d = length(to_light);
        // The filter averages over two pixels' width.
        CHECK(lux(image, x, 4) ==
              doctest::Approx(candela * to_light.z / (d * d * d)).epsilon(0.02));
    }
}

TEST_CASE("rays are counted by what they look for") {
    Quads quads;
    quads.floor(metal(0.8f, 0.1f), 2);
    add_point_light(quads.scene, {0.5f, 0.5f, 2}, 1000);
    const auto renderer = make_cpu_frame_renderer({quads.scene, nullptr, {.samples = 2}});
    REQUIRE(renderer);
    const auto frame = (*renderer)->draw(0, from_above(3, 1, 5), {});
    REQUIRE(frame);
    CHECK(frame->rays.camera == 5 * 5 * 2);
    CHECK(frame->rays.mirror == 5 * 5 * 2);  // up into the dark
    CHECK(frame->rays.shadow == 5 * 5 * 2);
    CHECK(frame->rays.total() == 3 * 5 * 5 * 2);
}

TEST_CASE("a uniform sky that is not baked gives pi L, without noise where nothing hides it") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 2);
    quads.scene.sky = Sky{{7, 7, 7}, nullptr};
    const Image image = picture(quads.scene, nullptr, from_above(3, 1, 5), kMatte);
    for (const vec3& pixel : image.pixels) CHECK(pixel.x == doctest::Approx(kRho * 7));
    CHECK(picture(quads.scene, nullptr, from_above(-3, 1, 1), kMatte).pixels[0].x == 7);
}

TEST_CASE("a sky image that is not baked gives what its pixels do") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 2);
    // A hot band at 45 to 67.5 degrees round the pole +Z would be no row of the image, whose pole
    // is +Y: one pixel instead, whose irradiance follows from its solid angle and middle.
    auto image = std::make_shared<Image>(64, 32);
    image->at(20, 12) = {1000, 1000, 1000};
    quads.scene.sky = Sky{{1, 1, 1}, image};
    double expected = 0;
    constexpr int kSteps = 16;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double u = (20 + (i + 0.5) / kSteps) / 64, v = (12 + (k + 0.5) / kSteps) / 32;
            const double pi = 3.14159265358979, azimuth = (u - 0.5) * 2 * pi, polar = v * pi;
            const double z = -std::sin(polar) * std::cos(azimuth);
            expected += std::max(0.0, z) * std::sin(polar) * 1000 * 2 * pi * pi / (64 * 32) /
                        (kSteps * kSteps);
        }
    const Image drawn =
        picture(quads.scene, nullptr, from_above(3, 1, 1), {.samples = 256, .reflections = 0});
    CHECK(static_cast<double>(lux(drawn, 0, 0)) == doctest::Approx(expected).epsilon(0.002));
}

TEST_CASE("an emissive surface that is not baked gives the form factor's share") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 2);
    Material lamp = diffuse({0, 0, 0});
    lamp.emission = {200, 200, 200};
    // 1 m x 1 m at height 2, faces down, middle above the origin; seen from below it.
    quads.add(lamp, {-0.5f, 0.5f, 2}, {0.5f, 0.5f, 2}, {0.5f, -0.5f, 2}, {-0.5f, -0.5f, 2});
    const Image image =
        picture(quads.scene, nullptr, from_above(1, 0.01f, 1), {.samples = 1024, .reflections = 0});
    // Four corner rectangles of 0.5 x 0.5 at height 2 (Siegel & Howell, configuration factors).
    const double x = 0.25, r = std::sqrt(1 + x * x);
    const double corner = 2 * (x / r * std::atan(x / r)) / (2 * 3.14159265358979);
    CHECK(static_cast<double>(lux(image, 0, 0)) ==
          doctest::Approx(4 * corner * 3.14159265358979 * 200).epsilon(0.01));
}

TEST_CASE("the shadow of a body moves with it over a baked floor, and the old one is gone") {
    // A slab at height 1 under a sun at 45 degrees: its shadow falls 1 m further along +x.
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 4);
    const int slab = quads.add(diffuse({kRho, kRho, kRho}), {-0.25f, -0.25f, 1}, {0.25f, -0.25f, 1},
                               {0.25f, 0.25f, 1}, {-0.25f, 0.25f, 1});
    Scene& scene = quads.scene;
    scene.nodes[static_cast<size_t>(slab)].translation = {-2, 0, 0};
    move_along_x(scene, slab, 3);
    const float sunlight = 1000 / std::sqrt(2.0f), ambient = 60;
    add_sun(scene, {0, -std::sin(kPi / 8), 0, std::cos(kPi / 8)});  // -Z turned towards +x

    Lit lit = quads.lit(64, {1, 1, 1});  // 8 texels to the metre
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const float at_x = (static_cast<float>(x) + 0.5f) / 8 - 4;
            const float at_y = (static_cast<float>(y) + 0.5f) / 8 - 4;
            const bool shaded = std::abs(at_x + 1) < 0.25f && std::abs(at_y) < 0.25f;
            lit.irradiance.at(x, y) = vec3{1, 1, 1} * (ambient + (shaded ? 0 : sunlight));
        }
    for (int y = 0; y < 64; ++y)
        for (int x = 66; x < 130; ++x) lit.irradiance.at(x, y) = vec3{1, 1, 1} * sunlight;

    const int size = 64;
    const View view = from_above(5, 4, size);
    const auto pixel = [&](float x) { return static_cast<int>((x + 4) * 8); };
    const Image rest = picture(scene, &lit, view, kMatte);
    CHECK(lux(rest, pixel(-1), 32) == doctest::Approx(ambient));
    const Image moved = picture(scene, &lit, view, kMatte, 1);
    CHECK(lux(moved, pixel(2), 32) == doctest::Approx(ambient));
    // All else is lit, the outline of the old shadow included.
    int wrong = 0;
    for (int y = 4; y < 60; ++y)
        for (int x = 4; x < 60; ++x) {
            const vec2 at = position_of(x, y, 4, size);
            if (std::abs(at.y) < 0.5f && (std::abs(at.x - 1) < 0.5f || std::abs(at.x - 2) < 0.5f))
                continue;
            wrong += std::abs(lux(moved, x, y) - ambient - sunlight) > 1;
        }
    CHECK(wrong == 0);
    // The slab keeps its own light.
    CHECK(lux(moved, pixel(1), 32) == doctest::Approx(sunlight).epsilon(1e-3));
    // A scene at rest is drawn as it was baked.
    const Image still = picture(scene, &lit, view, kMatte, -1);
    CHECK(still.pixels == rest.pixels);
}

TEST_CASE("a lamp that moves takes its light along") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 4);
    Scene& scene = quads.scene;
    add_point_light(scene, {-1, 0, 1}, 4 * kPi * 100);
    move_along_x(scene, 1, 2);
    Lit lit = quads.lit(64, {0, 0, 0});
    const auto given = [](float lamp_x, vec2 at) {
        const vec3 to_lamp = vec3{lamp_x, 0, 1} - vec3{at.x, at.y, 0};
        const float d = length(to_lamp);
        return 100 / (d * d * d);
    };
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const vec2 at{(static_cast<float>(x) + 0.5f) / 8 - 4,
                          (static_cast<float>(y) + 0.5f) / 8 - 4};
            lit.irradiance.at(x, y) = vec3{1, 1, 1} * (20 + given(-1, at));
        }
    const int size = 32;
    const Image moved =
        picture(scene, &lit, from_above(5, 3, size), {.samples = 64, .reflections = 0}, 1);
    for (const int x : {4, 12, 20, 28}) {
        const vec2 at = position_of(x, 16, 3, size);
        CHECK(lux(moved, x, 16) == doctest::Approx(20 + given(1, at)).epsilon(0.03));
    }
}

namespace {

/// Draws black pixels until it fails.
class Failing : public FrameRenderer {
public:
    Failing(int frames, Errc error) : frames_(frames), error_(error) {}
    Result<DrawnFrame> draw(double, const View& view, const Monitor&) override {
        if (frames_-- <= 0) return fail(error_, "trace.comp: the device was lost");
        return DrawnFrame{Image(view.width, view.height), {{"trace", 1}}, 1};
    }
    std::string device() const override { return "failing"; }
    std::string accel() const override { return "none"; }

private:
    int frames_;
    Errc error_;
};

}  // namespace

TEST_CASE("a device that fails is warned of once, and another draws that frame and the rest") {
    for (const Errc error : {Errc::device_lost, Errc::out_of_memory}) {
        int made = 0;
        std::vector<Error> warnings;
        const auto renderer = make_falling_back(
            std::make_unique<Failing>(2, error),
            [&]() -> Result<std::unique_ptr<FrameRenderer>> {
                ++made;
                return std::make_unique<Failing>(100, error);
            },
            [&](const Error& e) { warnings.push_back(e); });
        const View view = from_above(1, 1, 2);
        for (int frame = 0; frame < 5; ++frame) CHECK(renderer->draw(frame, view, {}));
        CHECK(made == 1);
        REQUIRE(warnings.size() == 1);
        CHECK(warnings[0].code == error);
    }
}

TEST_CASE("errors of the input and interruptions are no reason to try another device") {
    for (const Errc error : {Errc::bad_argument, Errc::cancelled}) {
        bool made = false;
        const auto renderer = make_falling_back(
            std::make_unique<Failing>(0, error),
            [&]() -> Result<std::unique_ptr<FrameRenderer>> {
                made = true;
                return std::make_unique<Failing>(1, error);
            },
            [](const Error&) {});
        CHECK(renderer->draw(0, from_above(1, 1, 2), {}).error().code == error);
        CHECK_FALSE(made);
    }
    // Where the other cannot be made either, every frame says why.
    const auto renderer = make_falling_back(
        std::make_unique<Failing>(0, Errc::device_lost),
        []() -> Result<std::unique_ptr<FrameRenderer>> {
            return fail(Errc::out_of_memory, "no memory");
        },
        [](const Error&) {});
    CHECK(renderer->draw(0, from_above(1, 1, 2), {}).error().message == "no memory");
}

TEST_CASE("impossible depths of reflection and interruptions are errors") {
    Quads quads;
    quads.floor(diffuse({kRho, kRho, kRho}), 1);
    for (const int reflections : {-1, kMostReflections + 1})
        CHECK(make_cpu_frame_renderer({quads.scene, nullptr, {.reflections = reflections}})
                  .error()
                  .code == Errc::bad_argument);
    const std::atomic<bool> cancel = true;
    auto renderer = make_cpu_frame_renderer({quads.scene, nullptr, {}});
    REQUIRE(renderer);
    CHECK((*renderer)->draw(0, from_above(1, 1, 4), {{}, &cancel}).error().code == Errc::cancelled);
}
