// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/light_coding.h"

#include "aglow/core/parallel.h"
#include "aglow/scene/image_file.h"

#include <algorithm>
#include <cmath>

namespace aglow::encode {
namespace {

constexpr double kPercentile = 0.999;

float largest(vec3 c) { return std::max({c.x, c.y, c.z}); }

std::vector<float> covered_maxima(const Lightmap& lightmap) {
    std::vector<float> maxima;
    for (size_t i = 0; i < lightmap.covered.size(); ++i) {
        if (lightmap.covered[i] != 0) maxima.push_back(largest(lightmap.irradiance.pixels[i]));
    }
    return maxima;
}

uint8_t byte_of(float value) { return static_cast<uint8_t>(std::lround(255.0f * value)); }

}  // namespace

double round_up(double value) {
    if (!(value > 0)) return 1;
    const double exponent = std::floor(std::log10(value)) - 1;
    // Negative powers of ten are not exact: divide by the exact positive one instead.
    const double unit = std::pow(10.0, std::fabs(exponent));
    const double digits = exponent < 0 ? std::ceil(value * unit) : std::ceil(value / unit);
    return exponent < 0 ? digits / unit : digits * unit;
}

Result<CodedLight> code_light(const Lightmap& lightmap) {
    CodedLight coded;
    std::vector<float> maxima = covered_maxima(lightmap);
    if (!maxima.empty()) {
        const double rank = std::ceil(kPercentile * static_cast<double>(maxima.size())) - 1;
        const auto nth = maxima.begin() + static_cast<ptrdiff_t>(std::max(rank, 0.0));
        std::nth_element(maxima.begin(), nth, maxima.end());
        coded.intensity = round_up(static_cast<double>(*nth));
        const auto clipped = std::ranges::count_if(
            maxima, [&](float m) { return static_cast<double>(m) > coded.intensity; });
        coded.clipped_share = static_cast<double>(clipped) / static_cast<double>(maxima.size());
    }
    AG_TRY(coded.png, srgb_png(lightmap.irradiance, static_cast<float>(1 / coded.intensity)));
    return coded;
}

Result<std::vector<uint8_t>> srgb_png(const Image& image, float scale,
                                      const std::vector<float>& alpha) {
    const size_t channels = alpha.empty() ? 3 : 4;
    std::vector<uint8_t> bytes(image.pixels.size() * channels);
    parallel_for(image.pixels.size(), 65536, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            uint8_t* out = bytes.data() + i * channels;
            const vec3 color = image.pixels[i] * scale;
            out[0] = byte_of(linear_to_srgb(color.x));
            out[1] = byte_of(linear_to_srgb(color.y));
            out[2] = byte_of(linear_to_srgb(color.z));
            if (channels == 4) out[3] = byte_of(std::clamp(alpha[i], 0.0f, 1.0f));
        }
    });
    auto png = encode_png(bytes, image.width, image.height, static_cast<int>(channels));
    if (png.empty()) return fail(Errc::out_of_memory, "no memory to write the lightmap's PNG");
    return png;
}

}  // namespace aglow::encode
