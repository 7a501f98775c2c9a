// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/tone_map.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace aglow;

namespace {

vec3 mapped(vec3 color, float ev = 0) {
    Image image(1, 1);
    image.pixels[0] = color;
    return tone_map(image, ev).pixels[0];
}

Image uniform(float value) {
    Image image(16, 16);
    for (vec3& p : image.pixels) p = {value, value, value};
    return image;
}

}  // namespace

TEST_CASE("automatic exposure brings the geometric mean to middle grey, at every brightness") {
    for (float nits : {1e-3f, 1.0f, 318.3f, 1e5f}) {
        CAPTURE(nits);
        Image image = uniform(nits);
        for (size_t i = 0; i < image.pixels.size(); i += 2) image.pixels[i] *= 16.0f;
        const float ev = automatic_exposure(image);
        CHECK(4 * nits * std::exp2(ev) == doctest::Approx(0.18).epsilon(1e-4));
    }
}

TEST_CASE("automatic exposure keeps a white picture at half of white") {
    CHECK(70 * std::exp2(automatic_exposure(uniform(70))) == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("unlit and non-finite pixels do not change the exposure") {
    Image image = uniform(10);
    const float before = automatic_exposure(image);
    for (size_t i = 0; i < 64; ++i) image.pixels[i] = {0, 0, 0};
    image.pixels[100].x = std::numeric_limits<float>::quiet_NaN();
    CHECK(automatic_exposure(image) == doctest::Approx(before));
    CHECK(automatic_exposure(uniform(0)) == 0);
}

TEST_CASE("an almost black background does not overexpose the object before it") {
    Image image = uniform(1e-12f);  // 240 of 256 pixels
    for (size_t i = 0; i < 16; ++i) image.pixels[i] = {100, 100, 100};
    CHECK(100 * std::exp2(automatic_exposure(image)) == doctest::Approx(4.0).epsilon(1e-4));
}

TEST_CASE("one stop of exposure doubles what is below the shoulder") {
    const vec3 c = mapped({0.1f, 0.05f, 0.2f}, 1);
    CHECK(c.x == doctest::Approx(0.2));
    CHECK(c.y == doctest::Approx(0.1));
    CHECK(c.z == doctest::Approx(0.4));
}

TEST_CASE("the shoulder rises steadily and stays below white") {
    float last = 0;
    for (float v = 0.01f; v < 1e3f; v *= 1.05f) {
        CAPTURE(v);
        const float d = mapped({v, v, v}).y;
        CHECK(d > last);
        CHECK(d < 1);
        if (v <= 0.5f) CHECK(d == doctest::Approx(v));
        last = d;
    }
    CHECK(last > 0.99f);
}

TEST_CASE("hue is kept at every exposure") {
    // Hue is fixed by where the middle channel stands between the least and the largest.
    for (float ev : {-3.0f, 0.0f, 2.0f, 6.0f}) {
        CAPTURE(ev);
        const vec3 c = mapped({0.9f, 0.3f, 0.1f}, ev);
        CHECK((c.y - c.z) / (c.x - c.z) == doctest::Approx(0.25).epsilon(1e-3));
    }
}

TEST_CASE("strong colours fade to white as they are overexposed") {
    const vec3 a = mapped({2, 0.02f, 0.02f}), b = mapped({200, 2, 2});
    CHECK(b.y / b.x > a.y / a.x);
    CHECK(b.y / b.x > 0.9f);
}

TEST_CASE("negative and non-finite pixels give displayable colours") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(mapped({nan, 1, 1}) == vec3{0, 0, 0});
    CHECK(mapped({std::numeric_limits<float>::infinity(), 0, 0}) == vec3{0, 0, 0});
    CHECK(mapped({-1, 0.25f, -2}) == vec3{0, 0.25f, 0});
}
