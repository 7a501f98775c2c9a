// SPDX-License-Identifier: Apache-2.0
#include "aglow/shared/shading.h"
#include "aglow/shared/wavefront.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace aglow;

TEST_CASE("the order of pixels passes each pixel of an image once") {
    for (const uint32_t width : {1u, 7u, 8u, 9u, 40u}) {
        const uint32_t height = 19, blocks = (width + 7) / 8 * ((height + 7) / 8);
        std::vector<int> visits(size_t{width} * height);
        for (uint32_t i = 0; i < 64 * blocks; ++i) {
            const shared::uvec2 pixel = shared::tile_pixel(i, width);
            if (pixel.x < width && pixel.y < height) ++visits[pixel.y * width + pixel.x];
        }
        for (const int count : visits) CHECK(count == 1);
    }
}

TEST_CASE("a steep power is that of the standard library") {
    for (const float base : {0.0f, 1e-6f, 0.3f, 0.9f, 0.999f, 0.99999f, 1.0f})
        for (const float exponent : {0.0f, 0.4f, 1.0f, 7.5f, 300.25f, 4999.5f}) {
            CAPTURE(base);
            CAPTURE(exponent);
            const double wanted =
                std::pow(static_cast<double>(base), static_cast<double>(exponent));
            CHECK(static_cast<double>(shared::steep_power(base, exponent)) ==
                  doctest::Approx(wanted).epsilon(1e-3));
        }
}
