// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/false_color.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace aglow;

namespace {

/// CIE 1976 lightness, 0..100.
double cie_lightness(vec3 c) { return 116 * std::cbrt(double{luminance(c)}) - 16; }

float distance(vec3 a, vec3 b) { return length(a - b); }

}  // namespace

TEST_CASE("the scale runs from dark blue to yellow, lighter at every step") {
    const vec3 low = false_color(0), high = false_color(1);
    CHECK(low.z > 3 * std::max(low.x, low.y));
    CHECK(cie_lightness(low) < 15);
    CHECK(high.x > 3 * high.z);
    CHECK(high.y > 3 * high.z);
    CHECK(cie_lightness(high) > 85);
    for (int i = 0; i < 100; ++i) {
        CAPTURE(i);
        const double step = cie_lightness(false_color(float(i + 1) / 100)) -
                            cie_lightness(false_color(float(i) / 100));
        CHECK(step > 0.6);  // about 0.8 of 100 on average
        CHECK(step < 1.1);
    }
}

TEST_CASE("values outside 0..1 take the colour of the nearer end") {
    CHECK(false_color(-3) == false_color(0));
    CHECK(false_color(7) == false_color(1));
    CHECK(false_color(std::numeric_limits<float>::quiet_NaN()) == false_color(0));
}

TEST_CASE("the scale ends at a round number at or above the brightest values") {
    const auto maximum = [](std::vector<float> lux) { return false_color_maximum(lux); };
    CHECK(maximum({0, 437}) == 500);
    CHECK(maximum({500}) == 500);
    CHECK(maximum({0.013f, 0.0142f}) == doctest::Approx(0.015));
    CHECK(maximum({9.2e4f}) == 1e5f);
    CHECK(maximum({0, 0}) == 1);
    CHECK(maximum({std::numeric_limits<float>::quiet_NaN()}) == 1);

    std::vector<float> lux(1000, 180.0f);  // five outliers of a thousand do not stretch the scale
    for (size_t i = 0; i < 5; ++i) lux[i] = 1e6f;
    CHECK(maximum(lux) == 200);
}

TEST_CASE("each pixel of the map has its value's colour, and the legend stands beside it") {
    const int width = 320, height = 250;
    std::vector<float> lux(size_t{width} * height);
    for (size_t i = 0; i < lux.size(); ++i) lux[i] = float(i % width) + 0.5f;
    const Image image = false_color_image(lux, width, height);
    const float end = false_color_maximum(lux);
    CHECK(end == 400);
    CHECK(image.height == height);
    CHECK(image.width > width + 30);
    for (int x : {0, 100, 319})
        CHECK(distance(image.at(x, 7), false_color((float(x) + 0.5f) / end)) < 1e-6f);
}

TEST_CASE("the legend's bar shows the scale from its end on top to 0 below") {
    const std::vector<float> lux(400 * 300, 350.0f);
    const Image image = false_color_image(lux, 400, 300);
    const int x = 400 + 15;  // inside the bar
    std::vector<int> rows;   // rows of the bar
    for (int y = 0; y < image.height; ++y)
        if (image.at(x, y).z > 0.02f) rows.push_back(y);
    REQUIRE(rows.size() > 250);
    CHECK(distance(image.at(x, rows.front()), false_color(1)) < 0.02f);
    CHECK(distance(image.at(x, rows.back()), false_color(0)) < 0.02f);
    CHECK(distance(image.at(x, (rows.front() + rows.back()) / 2), false_color(0.5f)) < 0.02f);
}

TEST_CASE("a map of a few sensors is magnified, pixels without a value are grey") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> lux = {100, nan, 50, 0};
    const Image image = false_color_image(lux, 2, 2);
    REQUIRE(image.height == 240);
    CHECK(image.at(0, 0) == image.at(119, 119));
    CHECK(image.at(0, 0) == false_color(1));
    CHECK(distance(image.at(60, 180), false_color(0.5f)) < 1e-6f);
    const vec3 none = image.at(180, 60);
    CHECK(none.x == none.y);
    CHECK(none.y == none.z);
    CHECK(none.x < 0.05f);
}
