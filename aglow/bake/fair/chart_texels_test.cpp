// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair/chart_texels.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;
using namespace aglow::bake::fair;

namespace {

vec2 point_of(const ChartTriangle& t, vec2 b) {
    return t[0] * (1 - b.x - b.y) + t[1] * b.x + t[2] * b.y;
}

}  // namespace

TEST_CASE("texels inside a triangle hold the place of their centre, those near it the nearest") {
    const ChartTriangle triangle = {vec2{2, 3}, vec2{12, 4}, vec2{5, 13}};
    const auto texels = chart_texels(std::span(&triangle, 1), 16, 20, 2);
    size_t inside = 0, near = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 16; ++x) {
            const ChartTexel& texel = texels[static_cast<size_t>(16 * y + x)];
            if (texel.triangle == UINT32_MAX) continue;
            const vec2 off =
                point_of(triangle, texel.barycentrics) - vec2{float(x) + 0.5f, float(y) + 0.5f};
            const float distance = std::sqrt(dot(off, off));
            ++(texel.inside ? inside : near);
            CHECK(distance < (texel.inside ? 1e-4f : 2.0f));
            CHECK(texel.barycentrics.x >= 0);
            CHECK(texel.barycentrics.y >= 0);
            CHECK(texel.barycentrics.x + texel.barycentrics.y <= 1.00001f);
        }
    CHECK(inside == doctest::Approx(48.5).epsilon(0.1));  // its area
    CHECK(near > 40);
}

TEST_CASE("a texel goes to the triangle that it is in, even beside a gutter met before") {
    const std::array<ChartTriangle, 2> two = {ChartTriangle{vec2{0, 0}, vec2{4, 0}, vec2{0, 4}},
                                              ChartTriangle{vec2{4, 0}, vec2{4, 4}, vec2{0, 4}}};
    const auto texels = chart_texels(two, 4, 4, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const ChartTexel& texel = texels[static_cast<size_t>(4 * y + x)];
            CHECK(texel.inside);
            if (x + y != 3) CHECK(texel.triangle == (x + y > 3 ? 1u : 0u));
        }
}

TEST_CASE("triangles without area give their gutter places, and none give none") {
    const ChartTriangle point = {vec2{2, 2}, vec2{2, 2}, vec2{2, 2}};
    const auto texels = chart_texels(std::span(&point, 1), 4, 4, 1);
    CHECK(texels[5].triangle == 0);
    CHECK_FALSE(texels[5].inside);
    CHECK(texels[15].triangle == UINT32_MAX);
    for (const ChartTexel& texel : chart_texels({}, 3, 3, 2)) CHECK(texel.triangle == UINT32_MAX);
}
