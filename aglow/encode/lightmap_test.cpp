// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/lightmap.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <set>

using namespace aglow;

namespace {

/// Texels of a width x height atlas with the given pixels covered.
Texels texels_at(int width, int height, const std::set<uint32_t>& pixels) {
    Texels texels;
    texels.width = width;
    texels.height = height;
    texels.element_at.assign(static_cast<size_t>(width * height), kNoElement);
    for (const uint32_t pixel : pixels) {
        texels.element_at[pixel] = static_cast<uint32_t>(texels.pixel_of.size());
        texels.pixel_of.push_back(pixel);
    }
    return texels;
}

/// A random set of covered pixels.
std::set<uint32_t> random_pixels(int width, int height) {
    const auto last = static_cast<uint32_t>(width * height);
    return *rc::gen::container<std::set<uint32_t>>(rc::gen::inRange(0u, last));
}

int chebyshev_to_covered(const Lightmap& map, int x, int y) {
    int nearest = 1 << 20;
    for (int v = 0; v < map.irradiance.height; ++v)
        for (int u = 0; u < map.irradiance.width; ++u)
            if (map.covered[static_cast<size_t>(v * map.irradiance.width + u)])
                nearest = std::min(nearest, std::max(std::abs(u - x), std::abs(v - y)));
    return nearest;
}

}  // namespace

TEST_CASE("covered texels keep their values and a constant stays constant in the gutter") {
    rc::check([] {
        const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
        const int gutter = *rc::gen::inRange(0, 4);
        const Texels texels = texels_at(width, height, random_pixels(width, height));
        // One third has no exact binary form: means of it must still be exactly it.
        const vec3 light{1.0f / 3, 2.0f / 3, 0.1f};
        const std::vector<vec3> values(texels.element_count(), light);
        const Lightmap map = make_lightmap(texels, values, gutter);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const int distance = chebyshev_to_covered(map, x, y);
                const vec3 expected = distance <= gutter ? light : vec3{0, 0, 0};
                RC_ASSERT(map.irradiance.at(x, y) == expected);
            }
        }
    });
}

TEST_CASE("a bilinear look-up inside a covered texel never meets an empty one") {
    rc::check([] {
        const int width = *rc::gen::inRange(1, 16), height = *rc::gen::inRange(1, 16);
        const auto pixels = random_pixels(width, height);
        RC_PRE(!pixels.empty());
        const Texels texels = texels_at(width, height, pixels);
        std::vector<vec3> values;
        for (size_t i = 0; i < pixels.size(); ++i) {
            const float v = 5.0f + static_cast<float>(*rc::gen::inRange(0, 100)) / 100.0f;
            values.push_back({v, v, v});
        }
        const Lightmap map = make_lightmap(texels, values, 1);
        const uint32_t pixel = *rc::gen::elementOf(texels.pixel_of);
        const float u = static_cast<float>(*rc::gen::inRange(0, 1001)) / 1000.0f;
        const float v = static_cast<float>(*rc::gen::inRange(0, 1001)) / 1000.0f;
        const auto x = static_cast<float>(pixel % static_cast<uint32_t>(width));
        const auto y = static_cast<float>(pixel / static_cast<uint32_t>(width));
        const vec3 light = sample_lightmap(map.irradiance, {x + u, y + v});
        RC_ASSERT(light.x >= 4.9999f);
        RC_ASSERT(light.x <= 6.0001f);
    });
}

TEST_CASE("a gutter texel is the mean of the covered texels that touch it") {
    const Texels texels = texels_at(3, 1, {0, 2});
    const Lightmap map = make_lightmap(texels, std::vector<vec3>{{1, 2, 3}, {3, 6, 5}}, 1);
    CHECK(map.irradiance.at(1, 0) == vec3{2, 4, 4});
    CHECK(map.irradiance.at(0, 0) == vec3{1, 2, 3});
    CHECK(map.covered == std::vector<uint8_t>{1, 0, 1});
}

TEST_CASE("a side neighbour counts before a diagonal one") {
    // . B      the texel at (0, 0) touches B at its side and C at its corner
    // A C
    const Texels texels = texels_at(2, 2, {1, 3});
    const Lightmap map = make_lightmap(texels, std::vector<vec3>{{8, 8, 8}, {2, 2, 2}}, 1);
    CHECK(map.irradiance.at(0, 0) == vec3{8, 8, 8});
    CHECK(map.irradiance.at(0, 1) == vec3{2, 2, 2});
}

TEST_CASE("the bilinear look-up reproduces a linear function between texel centres") {
    Image image(7, 5);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x)
            image.at(x, y) = {static_cast<float>(x), static_cast<float>(y),
                              static_cast<float>(2 * x - 3 * y)};
    for (float v = 0.5f; v <= 4.5f; v += 0.125f) {
        for (float u = 0.5f; u <= 6.5f; u += 0.125f) {
            const vec3 value = sample_lightmap(image, {u, v});
            CHECK(value.x == doctest::Approx(u - 0.5f).epsilon(1e-5));
            CHECK(value.y == doctest::Approx(v - 0.5f).epsilon(1e-5));
            CHECK(value.z ==
                  doctest::Approx(2 * (u - 0.5f) - 3 * (v - 0.5f)).epsilon(1e-5).scale(1));
        }
    }
}

TEST_CASE("outside the image the edge goes on") {
    Image image(2, 2);
    image.at(1, 1) = {4, 4, 4};
    CHECK(sample_lightmap(image, {9, 9}) == vec3{4, 4, 4});
    CHECK(sample_lightmap(image, {-9, 9}) == vec3{0, 0, 0});
    CHECK(sample_lightmap(Image(), {1, 1}) == vec3{0, 0, 0});
}
