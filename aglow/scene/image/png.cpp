// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/scene/image/codecs.h"
#include "aglow/scene/image_file.h"

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <array>
#include <climits>
#include <memory>
#include <new>

namespace aglow {
namespace image {
namespace {

template <class T>
using Pixels = std::unique_ptr<T, decltype(&stbi_image_free)>;

tl::unexpected<Error> stb_failure() {
    const char* reason = stbi_failure_reason();
    return fail(Errc::malformed,
                fmt::format("cannot be decoded: {}", reason ? reason : "unknown reason"));
}

/// Copies RGB samples of any integer type through a table that makes them linear.
template <class T>
Image through_table(const T* samples, int width, int height) {
    constexpr size_t kValues = size_t{1} << (8 * sizeof(T));
    std::vector<float> table(kValues);
    for (size_t i = 0; i < kValues; ++i)
        table[i] = srgb_to_linear(static_cast<float>(i) / static_cast<float>(kValues - 1));
    Image image(width, height);
    for (vec3& pixel : image.pixels) {
        pixel = {table[samples[0]], table[samples[1]], table[samples[2]]};
        samples += 3;
    }
    return image;
}

uint8_t to_byte(float linear) {
    if (!(linear > 0)) return 0;  // NaN too
    return static_cast<uint8_t>(linear_to_srgb(linear) * 255.0f + 0.5f);
}

}  // namespace

Result<Image> decode_srgb(Bytes bytes) {
    if (bytes.size() > INT_MAX) return fail(Errc::malformed, "is too large for a PNG or JPEG");
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
        return stb_failure();
    if (int64_t{width} * height > kMaxPixels)
        return fail(Errc::malformed, fmt::format("{} x {} pixels are too many", width, height));

    if (stbi_is_16_bit_from_memory(bytes.data(), size)) {
        const Pixels<stbi_us> pixels(
            stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, 3),
            &stbi_image_free);
        if (!pixels) return stb_failure();
        return through_table(pixels.get(), width, height);
    }
    const Pixels<stbi_uc> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3), &stbi_image_free);
    if (!pixels) return stb_failure();
    return through_table(pixels.get(), width, height);
}

Result<std::vector<uint8_t>> encode_srgb_png(const Image& image) {
    if (image.width < 1 || image.height < 1)
        return fail(Errc::bad_argument, "an image without pixels cannot be a PNG");
    std::vector<uint8_t> rgb;
    rgb.reserve(image.pixels.size() * 3);
    for (const vec3& pixel : image.pixels)
        rgb.insert(rgb.end(), {to_byte(pixel.x), to_byte(pixel.y), to_byte(pixel.z)});
    std::vector<uint8_t> png = encode_png(rgb, image.width, image.height, 3);
    if (png.empty()) return fail(Errc::out_of_memory, "the PNG does not fit into memory");
    return png;
}

}  // namespace image

std::vector<uint8_t> encode_png(std::span<const uint8_t> pixels, int width, int height,
                                int channels) {
    AG_ASSERT(width > 0 && height > 0 && channels >= 1 && channels <= 4, "an image with pixels");
    AG_ASSERT(pixels.size() == static_cast<size_t>(width) * static_cast<size_t>(height) *
                                   static_cast<size_t>(channels),
              "one byte per channel and pixel");
    std::vector<uint8_t> png;
    const auto append = [](void* context, void* data, int size) noexcept {
        const uint8_t* bytes = static_cast<const uint8_t*>(data);
        auto* out = static_cast<std::vector<uint8_t>*>(context);
        try {
            out->insert(out->end(), bytes, bytes + size);
        } catch (const std::bad_alloc&) {
            out->clear();  // the caller of stb is told by the empty result
        }
    };
    if (!stbi_write_png_to_func(append, &png, width, height, channels, pixels.data(),
                                width * channels))
        png.clear();
    return png;
}

}  // namespace aglow
