// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/texture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;

namespace {

/// 4 x 2 texels whose red counts columns and green rows, both times 40; blue 0, alpha 255.
Scene four_by_two() {
    Scene scene;
    TextureImage image;
    image.width = 4;
    image.height = 2;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x)
            image.rgba.insert(image.rgba.end(),
                              {static_cast<uint8_t>(40 * x), static_cast<uint8_t>(40 * y), 0, 255});
    scene.images.push_back(image);
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    return scene;
}

TextureRef first_texture() {
    TextureRef reference;
    reference.texture = 0;
    return reference;
}

/// Column and row, fractional, that a sample came from.
vec2 place(const Scene& scene, const TextureRef& reference, vec2 uv) {
    const vec4 c = sample(scene, reference, uv, ColorCoding::linear) * (255.0f / 40);
    return {c.x, c.y};
}

vec2 texel_center(int x, int y) {
    return {(static_cast<float>(x) + 0.5f) / 4, (static_cast<float>(y) + 0.5f) / 2};
}

}  // namespace

TEST_CASE("a texel's centre gives that texel, row 0 on top") {
    const Scene scene = four_by_two();
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
            const vec2 p = place(scene, first_texture(), texel_center(x, y));
            CHECK(p.x == doctest::Approx(x).epsilon(1e-5));
            CHECK(p.y == doctest::Approx(y).epsilon(1e-5));
        }
}

TEST_CASE("between texels the colour is interpolated linearly") {
    const Scene scene = four_by_two();
    const vec2 p = place(scene, first_texture(), {(1.5f + 0.25f) / 4, (0.5f + 0.5f) / 2});
    CHECK(p.x == doctest::Approx(1.25));
    CHECK(p.y == doctest::Approx(0.5));
}

TEST_CASE("the nearest filter shows whole texels") {
    Scene scene = four_by_two();
    scene.textures[0].filter = Filter::nearest;
    CHECK(place(scene, first_texture(), {1.99f / 4, 0.99f / 2}).x == doctest::Approx(1));
    CHECK(place(scene, first_texture(), {2.01f / 4, 1.01f / 2}).y == doctest::Approx(1));
}

TEST_CASE("outside of the image each wrap mode shows what its name says") {
    Scene scene = four_by_two();
    const auto column = [&](Wrap wrap, int x) {
        scene.textures[0].wrap_s = wrap;
        return place(scene, first_texture(), texel_center(x, 0)).x;
    };
    for (const int x : {-9, -4, -1, 4, 7, 8, 13}) {
        CAPTURE(x);
        const int repeated = (x % 4 + 4) % 4, in_pair = (x % 8 + 8) % 8;
        CHECK(column(Wrap::repeat, x) == doctest::Approx(repeated).epsilon(1e-4));
        CHECK(column(Wrap::mirrored_repeat, x) ==
              doctest::Approx(in_pair < 4 ? in_pair : 7 - in_pair).epsilon(1e-4));
        CHECK(column(Wrap::clamp_to_edge, x) == doctest::Approx(x < 0 ? 0 : 3).epsilon(1e-4));
    }
}

TEST_CASE("a repeated texture blends across its seam, a clamped one does not") {
    Scene scene = four_by_two();
    CHECK(place(scene, first_texture(), {0, 0.25f}).x == doctest::Approx(1.5));
    scene.textures[0].wrap_s = Wrap::mirrored_repeat;
    CHECK(place(scene, first_texture(), {0, 0.25f}).x == doctest::Approx(0));
    scene.textures[0].wrap_s = Wrap::clamp_to_edge;
    CHECK(place(scene, first_texture(), {1, 0.25f}).x == doctest::Approx(3));
}

TEST_CASE("sRGB-coded bytes come out linear, alpha as it is") {
    Scene scene;
    TextureImage image;
    image.width = image.height = 1;
    image.rgba = {255, 128, 10, 128};
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0});
    const vec4 c = sample(scene, first_texture(), {0.3f, 0.9f}, ColorCoding::srgb);
    CHECK(c.x == doctest::Approx(1));
    CHECK(c.y == doctest::Approx(0.215861).epsilon(1e-4));            // IEC 61966-2-1
    CHECK(c.z == doctest::Approx(10 / 255.0 / 12.92).epsilon(1e-4));  // its linear toe
    CHECK(c.w == doctest::Approx(128 / 255.0));
}

TEST_CASE("the extension's own example shows the lower left quadrant, turned clockwise") {
    // KHR_texture_transform: offset (0, 1), rotation pi / 2, scale (0.5, 0.5).
    const Scene scene = four_by_two();
    TextureRef reference = first_texture();
    reference.offset = {0, 1};
    reference.rotation = kPi / 2;
    reference.scale = {0.5f, 0.5f};
    // The quadrant's upper left, (0, 0.5), lands at the surface's upper right, (1, 0).
    const vec2 upper_right = place(scene, reference, {0.75f, 0.25f});
    CHECK(upper_right.x == doctest::Approx(0).epsilon(1e-4));  // uv (0.125, 0.625)
    CHECK(upper_right.y == doctest::Approx(0.75).epsilon(1e-4));
    const vec2 lower_right = place(scene, reference, {0.75f, 0.75f});
    CHECK(lower_right.x == doctest::Approx(1).epsilon(1e-4));  // uv (0.375, 0.625)
}

TEST_CASE("no texture reads one, and coordinates of any size are safe") {
    const Scene scene = four_by_two();
    CHECK(sample(scene, {}, {0.1f, 0.2f}, ColorCoding::srgb) == vec4{1, 1, 1, 1});
    TextureRef huge = first_texture();
    huge.scale = {1e38f, -1e38f};
    for (const float v : {-1e30f, -1.0f, 0.99999994f, 1e9f, 1e38f}) {
        const vec4 c = sample(scene, huge, {v, v}, ColorCoding::linear);
        CHECK((c.x >= 0 && c.x <= 1 && c.w == 1));
    }
}
