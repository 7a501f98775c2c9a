// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights/sky_distribution.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace aglow::transport {
namespace {

/// Index and fraction of `u` within cumulative weights that end in 1.
std::pair<int, float> invert(std::span<const double> cumulative, float u) {
    const auto after =
        std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, static_cast<double>(u));
    const auto index = after - cumulative.begin() - 1;
    const double lo = cumulative[static_cast<size_t>(index)];
    const double width = cumulative[static_cast<size_t>(index) + 1] - lo;
    const double fraction = width > 0 ? (static_cast<double>(u) - lo) / width : 0.5;
    return {static_cast<int>(index), static_cast<float>(std::clamp(fraction, 0.0, 1.0))};
}

}  // namespace

vec3 equirectangular_direction(vec2 uv) {
    const float azimuth = (uv.x - 0.5f) * 2 * kPi;  // from -Z towards +X
    const float polar = uv.y * kPi;
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar),
            -std::sin(polar) * std::cos(azimuth)};
}

vec2 equirectangular_uv(vec3 d) {
    return {0.5f + std::atan2(d.x, -d.z) / (2 * kPi),
            std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPi};
}

SkyDistribution::SkyDistribution(const Image& sky) : width_(sky.width), height_(sky.height) {
    const auto w = static_cast<size_t>(width_), h = static_cast<size_t>(height_);
    rows_.assign(h + 1, 0);
    cells_.assign(h * (w + 1), 0);
    for (size_t y = 0; y < h; ++y) {
        double* row = &cells_[y * (w + 1)];
        for (size_t x = 0; x < w; ++x)
            row[x + 1] = row[x] + static_cast<double>(luminance(sky.pixels[y * w + x]));
        const double sum = row[w];
        const double sine = std::sin((static_cast<double>(y) + 0.5) / static_cast<double>(h) *
                                     static_cast<double>(kPi));
        rows_[y + 1] = rows_[y] + sum * sine;
        for (size_t x = 0; x <= w; ++x)
            row[x] = sum > 0 ? row[x] / sum : static_cast<double>(x) / static_cast<double>(w);
    }
    const double total = rows_[h];
    if (!(total > 0)) {
        rows_.clear();
        return;
    }
    for (double& value : rows_) value /= total;
}

float SkyDistribution::density(int x, int y) const {
    const auto w = static_cast<size_t>(width_), r = static_cast<size_t>(y),
               c = static_cast<size_t>(x);
    const double* row = &cells_[r * (w + 1)];
    return static_cast<float>((rows_[r + 1] - rows_[r]) * height_ * (row[c + 1] - row[c]) * width_);
}

SkyDistribution::Sample SkyDistribution::draw(vec2 u) const {
    const auto [y, fy] = invert(rows_, u.y);
    const auto w = static_cast<size_t>(width_);
    const auto [x, fx] = invert(std::span(&cells_[static_cast<size_t>(y) * (w + 1)], w + 1), u.x);
    const vec2 uv{(static_cast<float>(x) + fx) / static_cast<float>(width_),
                  (static_cast<float>(y) + fy) / static_cast<float>(height_)};
    const float sine = std::sin(uv.y * kPi);
    if (!(sine > 0)) return {{0, 1, 0}, 0};
    return {equirectangular_direction(uv), density(x, y) / (2 * kPi * kPi * sine)};
}

float SkyDistribution::pdf(vec3 direction) const {
    if (black()) return 0;
    const vec2 uv = equirectangular_uv(direction);
    const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(width_)), 0, width_ - 1);
    const int y = std::clamp(static_cast<int>(uv.y * static_cast<float>(height_)), 0, height_ - 1);
    const float sine = std::sqrt(std::max(0.0f, 1 - direction.y * direction.y));
    return sine > 0 ? density(x, y) / (2 * kPi * kPi * sine) : 0;
}

}  // namespace aglow::transport
