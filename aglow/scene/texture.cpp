// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/texture.h"

#include <array>
#include <cmath>

namespace aglow {
namespace {

std::array<float, 256> byte_table(ColorCoding coding) {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i) {
        const float value = static_cast<float>(i) / 255.0f;
        table[i] = coding == ColorCoding::srgb ? srgb_to_linear(value) : value;
    }
    return table;
}

const std::array<float, 256> kLinear = byte_table(ColorCoding::linear);
const std::array<float, 256> kFromSrgb = byte_table(ColorCoding::srgb);

/// KHR_texture_transform: scale, then rotate, then offset. V points down in glTF images, so a
/// counter-clockwise turn of the UVs takes (1, 0) to (0, -1).
vec2 transformed(const TextureRef& reference, vec2 uv) {
    const vec2 scaled = uv * reference.scale;
    const float c = std::cos(reference.rotation), s = std::sin(reference.rotation);
    return vec2{c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x} + reference.offset;
}

/// Brings a coordinate into the one period that matters, so that far coordinates keep their
/// precision and fit into an int. Overflow to infinity in the transform lands at 0.
float reduced(float coordinate, Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0;
    switch (wrap) {
        case Wrap::repeat:
            return coordinate - std::floor(coordinate);
        case Wrap::mirrored_repeat:
            return coordinate - 2 * std::floor(coordinate / 2);
        case Wrap::clamp_to_edge:
            break;
    }
    return std::clamp(coordinate, 0.0f, 1.0f);
}

/// Texel for an index up to one period outside of [0, size).
int wrapped(int index, int size, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return (index + size) % size;
        case Wrap::mirrored_repeat: {
            const int in_period = (index + 2 * size) % (2 * size);
            return in_period < size ? in_period : 2 * size - 1 - in_period;
        }
        case Wrap::clamp_to_edge:
            break;
    }
    return std::clamp(index, 0, size - 1);
}

vec4 texel(const TextureImage& image, int x, int y, const std::array<float, 256>& color) {
    const size_t at =
        4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
    const uint8_t* rgba = image.rgba.data() + at;
    return {color[rgba[0]], color[rgba[1]], color[rgba[2]], kLinear[rgba[3]]};
}

}  // namespace

vec4 sample(const Scene& scene, const TextureRef& reference, vec2 uv, ColorCoding coding) {
    constexpr vec4 kOne{1, 1, 1, 1};
    if (reference.texture < 0) return kOne;
    const Texture& texture = scene.textures[static_cast<size_t>(reference.texture)];
    if (texture.image < 0) return kOne;
    const TextureImage& image = scene.images[static_cast<size_t>(texture.image)];
    if (image.rgba.empty()) return kOne;

    const auto& color = coding == ColorCoding::srgb ? kFromSrgb : kLinear;
    const vec2 at = transformed(reference, uv);
    const float x = reduced(at.x, texture.wrap_s) * static_cast<float>(image.width);
    const float y = reduced(at.y, texture.wrap_t) * static_cast<float>(image.height);
    const auto fetch = [&](float column, float row) {
        return texel(image, wrapped(static_cast<int>(column), image.width, texture.wrap_s),
                     wrapped(static_cast<int>(row), image.height, texture.wrap_t), color);
    };
    if (texture.filter == Filter::nearest) return fetch(std::floor(x), std::floor(y));

    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float s = x - 0.5f - left, t = y - 0.5f - top;
    const vec4 upper = fetch(left, top) * (1 - s) + fetch(left + 1, top) * s;
    const vec4 lower = fetch(left, top + 1) * (1 - s) + fetch(left + 1, top + 1) * s;
    return upper * (1 - t) + lower * t;
}

}  // namespace aglow
