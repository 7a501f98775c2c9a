// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/tone_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace aglow {
namespace {

constexpr float kMiddleGrey = 0.18f;
constexpr float kShoulder = 0.5f;     // display-linear value where compression starts
constexpr float kFade = 0.1f;         // how fast a compressed colour fades to white
constexpr float kDarkest = 1e-3f;     // of the bright part, see automatic_exposure()
constexpr float kLeastBright = 0.5f;  // of white, see automatic_exposure()
constexpr float kMostBright = 4.0f;   // of white, see automatic_exposure()
constexpr double kBrightPart = 0.95;  // percentile that stands for the bright part

/// The luminances above zero.
std::vector<float> lit_luminances(const Image& image) {
    std::vector<float> values;
    values.reserve(image.pixels.size());
    for (vec3 c : image.pixels)
        if (const float y = luminance(c); std::isfinite(y) && y > 0) values.push_back(y);
    return values;
}

/// Identity up to kShoulder, then a hyperbola with the same slope there and limit 1.
float compress(float peak) {
    if (peak <= kShoulder) return peak;
    const float t = (peak - kShoulder) / (1 - kShoulder);
    return kShoulder + (1 - kShoulder) * t / (1 + t);
}

vec3 display_color(vec3 c) {
    if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) return {0, 0, 0};
    c = shared::max(c, vec3{0, 0, 0});
    const float peak = std::max({c.x, c.y, c.z});
    const float mapped = compress(peak);
    if (mapped == peak) return c;
    const float fade = 1 - 1 / (1 + kFade * (peak - mapped));
    return shared::mix(c * (mapped / peak), vec3{mapped, mapped, mapped}, fade);
}

}  // namespace

float automatic_exposure(const Image& image) {
    std::vector<float> values = lit_luminances(image);
    if (values.empty()) return 0;
    const auto rank = static_cast<std::ptrdiff_t>(kBrightPart * double(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    const float bright = values[static_cast<size_t>(rank)];

    double log_sum = 0;
    for (float y : values) log_sum += std::log2(std::max(y, kDarkest * bright));
    const double average = log_sum / static_cast<double>(values.size());
    const double to_grey = std::log2(double{kMiddleGrey}) - average;
    const double to_white = -std::log2(double{bright});
    return static_cast<float>(std::clamp(to_grey, to_white + std::log2(double{kLeastBright}),
                                         to_white + std::log2(double{kMostBright})));
}

Image tone_map(const Image& image, float exposure_ev) {
    const float scale = std::exp2(exposure_ev);
    Image result(image.width, image.height);
    std::transform(image.pixels.begin(), image.pixels.end(), result.pixels.begin(),
                   [scale](vec3 c) { return display_color(c * scale); });
    return result;
}

}  // namespace aglow
