// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/false_color.h"

#include "aglow/core/assert.h"
#include "aglow/render/legend/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aglow {
namespace {

constexpr vec3 kNothing = {0.02f, 0.02f, 0.02f};
constexpr vec3 kPaper = {0.005f, 0.005f, 0.005f};
constexpr vec3 kInk = {0.8f, 0.8f, 0.8f};
constexpr int kLeastHeight = 240;     // pixels; lower maps are magnified
constexpr int kMostWidth = 1600;      // pixels; no map is magnified beyond it
constexpr int kPixelsPerScale = 280;  // image height for each step of the letters' size

/// Ends of the scale within a decade, and into how many round steps each is divided.
struct RoundNumber {
    double value;
    int steps;
};
constexpr RoundNumber kRoundNumbers[] = {{1, 5}, {1.5, 3}, {2, 4}, {2.5, 5}, {3, 6},
                                         {4, 4}, {5, 5},   {6, 6}, {8, 4},   {10, 5}};

/// The least round number at or above `value` > 0, with its power of ten.
struct Scale {
    RoundNumber mantissa;
    double power;
    double end() const { return mantissa.value * power; }
};

Scale round_up(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (RoundNumber number : kRoundNumbers)
        // The slack keeps a value that is round itself, but for rounding, at its own number.
        if (value <= number.value * power * (1 + 1e-6)) return {number, power};
    return {kRoundNumbers[0], power * 10};
}

Scale scale_of(std::span<const float> lux) {
    std::vector<float> values;
    std::copy_if(lux.begin(), lux.end(), std::back_inserter(values),
                 [](float v) { return std::isfinite(v); });
    if (values.empty()) return round_up(1);
    const double share = 0.99 * static_cast<double>(values.size() - 1);
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    const float high = values[static_cast<size_t>(rank)];
    return round_up(high > 0 ? double{high} : 1.0);
}

/// 0.25, 400, 12.5k
std::string label(double value, double end) {
    return end >= 1e4 ? fmt::format("{:.4g}k", value / 1000) : fmt::format("{:.4g}", value);
}

vec3 oklab_to_linear(float lightness, float a, float b) {
    const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    const vec3 lms = {l * l * l, m * m * m, s * s * s};
    return {dot(lms, {4.0767416621f, -3.3077115913f, 0.2309699292f}),
            dot(lms, {-1.2684380046f, 2.6097574011f, -0.3413193965f}),
            dot(lms, {-0.0041960863f, -0.7034186147f, 1.7076147010f})};
}

int magnification(int width, int height) {
    const int wanted = (kLeastHeight + height - 1) / height;
    return std::max(1, std::min(wanted, kMostWidth / width));
}

/// Colour bar with ticks, numbers and the unit, in the rectangle from column `left` on.
class Legend {
public:
    Legend(const Scale& scale, int height) : scale_(scale), size_(1 + height / kPixelsPerScale) {
        const int steps = scale.mantissa.steps;
        for (int i = 0; i <= steps; ++i)
            labels_.push_back(label(scale.end() * i / steps, scale.end()));
        for (const std::string& text : labels_)
            text_width_ = std::max(text_width_, render::text_width(text, size_));
    }

    int width() const { return 26 * size_ + text_width_; }

    void draw(Image& image, int left) const {
        // The unit stands above the bar; half a number's height is kept free at both ends.
        const int bar_left = left + 6 * size_, bar_width = 10 * size_,
                  text_left = left + 20 * size_;
        const int top = 16 * size_, bottom = image.height - 6 * size_;
        const int bar_height = std::max(bottom - top, 1);
        render::draw_text(image, "lx", text_left, 3 * size_, size_, kInk);
        for (int y = top; y < bottom; ++y) {
            const float value = (static_cast<float>(bottom - y) - 0.5f) / float(bar_height);
            render::fill(image, bar_left, y, bar_width, 1, false_color(value));
        }
        const int steps = scale_.mantissa.steps;
        for (int i = 0; i <= steps; ++i) {
            const int y = bottom - bar_height * i / steps;
            render::fill(image, bar_left + bar_width, y - size_ / 2, 2 * size_, size_, kInk);
            render::draw_text(image, labels_[static_cast<size_t>(i)], text_left,
                              y - render::kGlyphHeight * size_ / 2, size_, kInk);
        }
    }

private:
    Scale scale_;
    int size_;
    std::vector<std::string> labels_ = {};
    int text_width_ = 0;
};

}  // namespace

vec3 false_color(float value) {
    const float t = value > 0 ? std::min(value, 1.0f) : 0.0f;
    // Lightness and hue run straight; chroma follows the narrow waist of the display's gamut at
    // blue-green, so that every colour of the scale can be shown as it is.
    const float lightness = 0.24f + 0.68f * t;
    const float hue = (285.0f - 180.0f * t) * (kPi / 180.0f);
    const float chroma = 0.084f + 0.27f * (t - 0.38f) * (t - 0.38f);
    const vec3 c = oklab_to_linear(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
    return shared::min(shared::max(c, vec3{0, 0, 0}), vec3{1, 1, 1});
}

float false_color_maximum(std::span<const float> lux) {
    return static_cast<float>(scale_of(lux).end());
}

Image false_color_image(std::span<const float> lux, int width, int height) {
    AG_ASSERT(width > 0 && height > 0, "the map has pixels");
    AG_ASSERT(lux.size() == static_cast<size_t>(width) * static_cast<size_t>(height),
              "one value per pixel");
    const int zoom = magnification(width, height);
    const int map_width = width * zoom, map_height = height * zoom;
    const int image_height = std::max(map_height, kLeastHeight / 2);
    const Scale scale = scale_of(lux);
    const Legend legend(scale, image_height);

    Image image(map_width + legend.width(), image_height);
    render::fill(image, 0, 0, image.width, image.height, kPaper);
    for (int y = 0; y < map_height; ++y)
        for (int x = 0; x < map_width; ++x) {
            const auto source = static_cast<size_t>(y / zoom) * static_cast<size_t>(width) +
                                static_cast<size_t>(x / zoom);
            const float value = lux[source];
            image.at(x, y) = std::isfinite(value)
                                 ? false_color(value / static_cast<float>(scale.end()))
                                 : kNothing;
        }
    legend.draw(image, map_width);
    return image;
}

}  // namespace aglow
