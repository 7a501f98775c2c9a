// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/lightmap.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aglow {
namespace {

/// Which texels hold a value: 0 for none, else 1 + the pass that filled it.
struct Filling {
    Image& image;
    std::vector<uint8_t>& pass_of;

    bool filled(int x, int y, int before) const {
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) return false;
        const size_t at = static_cast<size_t>(y) * static_cast<size_t>(image.width);
        const int pass = pass_of[at + static_cast<size_t>(x)];
        return pass != 0 && pass <= before;
    }
};

/// Mean of those of the four texels at (x, y) + offsets that were filled before this pass. The sum
/// is kept in double so that equal neighbours give exactly their value.
std::optional<vec3> mean_of(const Filling& filling, int x, int y, const int (&offsets)[4][2],
                            int before) {
    double sum[3] = {0, 0, 0};
    int count = 0;
    for (const auto& offset : offsets) {
        const int u = x + offset[0];
        const int v = y + offset[1];
        if (!filling.filled(u, v, before)) continue;
        const vec3 value = filling.image.at(u, v);
        sum[0] += static_cast<double>(value.x);
        sum[1] += static_cast<double>(value.y);
        sum[2] += static_cast<double>(value.z);
        ++count;
    }
    if (count == 0) return std::nullopt;
    return vec3{static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
                static_cast<float>(sum[2] / count)};
}

/// Grows what is filled by one texel to all eight sides. A texel reads only what earlier passes
/// filled, so the order within a pass does not matter.
void grow(Filling& filling, int before) {
    constexpr int kSides[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    constexpr int kCorners[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    // Passes are told apart by number, and rows of one pass write only themselves; but a row's
    // neighbours are read while they may be written, hence the separate list of results.
    const size_t width = static_cast<size_t>(filling.image.width);
    std::vector<std::vector<std::pair<int, vec3>>> rows(static_cast<size_t>(filling.image.height));
    parallel_for(rows.size(), 16, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < filling.image.width; ++x) {
                if (filling.pass_of[row * width + static_cast<size_t>(x)] != 0) continue;
                std::optional<vec3> value = mean_of(filling, x, y, kSides, before);
                if (!value) value = mean_of(filling, x, y, kCorners, before);
                if (value) rows[row].emplace_back(x, *value);
            }
        }
    });
    for (size_t row = 0; row < rows.size(); ++row) {
        for (const auto& [x, value] : rows[row]) {
            filling.image.at(x, static_cast<int>(row)) = value;
            filling.pass_of[row * width + static_cast<size_t>(x)] =
                static_cast<uint8_t>(before + 1);
        }
    }
}

}  // namespace

Lightmap make_lightmap(const Texels& texels, std::span<const vec3> irradiance, int gutter) {
    AG_ASSERT(irradiance.size() == texels.element_count(), "one value per texel");
    Lightmap map{Image(texels.width, texels.height), {}};
    map.covered.assign(map.irradiance.pixels.size(), 0);
    for (size_t i = 0; i < texels.element_count(); ++i) {
        map.irradiance.pixels[texels.pixel_of[i]] = irradiance[i];
        map.covered[texels.pixel_of[i]] = 1;
    }
    std::vector<uint8_t> pass_of = map.covered;
    Filling filling{map.irradiance, pass_of};
    const int passes = std::clamp(gutter, 0, 254);
    for (int pass = 1; pass <= passes; ++pass) grow(filling, pass);
    return map;
}

vec3 sample_lightmap(const Image& irradiance, vec2 texel) {
    if (irradiance.width <= 0 || irradiance.height <= 0) return {0, 0, 0};
    const float right = static_cast<float>(irradiance.width - 1);
    const float bottom = static_cast<float>(irradiance.height - 1);
    const float x = std::clamp(texel.x - 0.5f, 0.0f, right);
    const float y = std::clamp(texel.y - 0.5f, 0.0f, bottom);
    const int x0 = static_cast<int>(x);
    const int y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, irradiance.width - 1);
    const int y1 = std::min(y0 + 1, irradiance.height - 1);
    const float u = x - static_cast<float>(x0);
    const float v = y - static_cast<float>(y0);
    const vec3 top = shared::mix(irradiance.at(x0, y0), irradiance.at(x1, y0), u);
    const vec3 below = shared::mix(irradiance.at(x0, y1), irradiance.at(x1, y1), u);
    return shared::mix(top, below, v);
}

}  // namespace aglow
