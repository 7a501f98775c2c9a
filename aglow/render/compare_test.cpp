// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/compare.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace aglow;

namespace {

Image grey(int width, int height, auto value) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float v = value(x, y);
            image.at(x, y) = {v, v, v};
        }
    return image;
}

}  // namespace

TEST_CASE("an image does not differ from itself") {
    const Image image = grey(7, 5, [](int x, int y) { return 0.5f + float(x) * float(y); });
    const Difference d = difference(image, image).value();
    CHECK(d.count == 35);
    CHECK(d.rmse == 0);
    CHECK(d.relative_rmse == 0);
    CHECK(d.mean_relative == 0);
    CHECK(d.max == 0);
    CHECK(d.median_relative == 0);
}

TEST_CASE("a constant factor gives the same relative error by every measure") {
    const Image b = grey(8, 8, [](int x, int y) { return 1.0f + float(x + y); });
    Image a = b;
    for (vec3& p : a.pixels) p *= 1.25f;
    const Difference d = difference(a, b).value();
    CHECK(d.relative_rmse == doctest::Approx(0.25));
    CHECK(d.mean_relative == doctest::Approx(0.25));
    CHECK(d.median_relative == doctest::Approx(0.25));
    CHECK(d.max == doctest::Approx(0.25 * 15));
}

TEST_CASE("one wrong channel of one pixel counts with its share") {
    const Image b = grey(2, 2, [](int, int) { return 3.0f; });
    Image a = b;
    a.at(1, 0).y = 9.0f;  // differs by 6 in one of 12 values
    const Difference d = difference(a, b).value();
    CHECK(d.rmse == doctest::Approx(std::sqrt(36.0 / 12.0)));
    CHECK(d.relative_rmse == doctest::Approx(std::sqrt(36.0 / 12.0) / 3.0));
    CHECK(d.mean_relative == doctest::Approx(6.0 / 36.0));
    CHECK(d.max == 6.0);
    CHECK(d.median_relative == 0);
}

TEST_CASE("the median is of luminance, over pixels where the reference is lit") {
    Image b(4, 1), a(4, 1);
    b.pixels = {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    a.pixels = {{5, 5, 5}, {1, 1, 1}, {1, 1.1f, 1}, {1, 1, 3}};
    CHECK(difference(a, b)->median_relative == doctest::Approx(0.7152 * 0.1).epsilon(1e-5));
    b.pixels[1] = a.pixels[1] = {0, 0, 0};
    CHECK(difference(a, b)->median_relative ==
          doctest::Approx((0.7152 * 0.1 + 0.0722 * 2) / 2).epsilon(1e-5));
}

TEST_CASE("masked and non-finite pixels are left out and counted") {
    Image b = grey(3, 1, [](int, int) { return 2.0f; });
    Image a = b;
    a.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
    a.at(1, 0) = {100, 100, 100};
    const std::vector<uint8_t> mask = {1, 0, 1};
    const Difference d = difference(a, b, mask).value();
    CHECK(d.count == 1);
    CHECK(d.non_finite == 1);
    CHECK(d.rmse == 0);
    CHECK(difference(a, b)->max == 98);
}

TEST_CASE("light where the reference has none is an infinite relative error") {
    const Image dark(2, 2);
    const Image lit = grey(2, 2, [](int, int) { return 1.0f; });
    CHECK(difference(dark, dark)->relative_rmse == 0);
    CHECK(std::isinf(difference(lit, dark)->relative_rmse));
    CHECK(std::isinf(difference(lit, dark)->mean_relative));
    CHECK(difference(lit, dark)->rmse == 1);
}

TEST_CASE("images of different size are not compared") {
    const auto result = difference(Image(3, 2), Image(2, 3));
    REQUIRE(!result);
    CHECK(result.error().code == Errc::bad_argument);
    CHECK(result.error().message.find("3x2 and 2x3") != std::string::npos);
}
