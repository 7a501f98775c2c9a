// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <vector>

namespace aglow {

/// Linear Rec. 709 pixels, row 0 on top. What a channel means (lux, cd/m^2, display) is the
/// holder's to say.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<vec3> pixels = {};  ///< [height * width]

    Image() = default;
    Image(int w, int h)
        : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h)) {}
    vec3& at(int x, int y) {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    const vec3& at(int x, int y) const {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

float srgb_to_linear(float encoded);  ///< IEC 61966-2-1, for 0 <= encoded <= 1
float linear_to_srgb(float linear);   ///< its inverse, clamped to 0..1

}  // namespace aglow
