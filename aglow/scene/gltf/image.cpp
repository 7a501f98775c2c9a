// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/image.h"

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>

namespace aglow::gltf {
namespace {

constexpr int64_t kMaxPixels = int64_t{1} << 28;  // 16384 x 16384, a GiB decoded

template <size_t N>
bool starts_with(std::span<const uint8_t> bytes, const uint8_t (&magic)[N], size_t at = 0) {
    return bytes.size() >= at + N &&
           std::equal(magic, magic + N, bytes.begin() + static_cast<ptrdiff_t>(at));
}

Result<ImageSize> check_size(int width, int height, const std::string& element) {
    if (width <= 0 || height <= 0)
        return fail(Errc::malformed, element + ": the image does not decode");
    if (static_cast<int64_t>(width) * height > kMaxPixels)
        return fail(Errc::unsupported,
                    fmt::format("{}: {} x {} pixels are too many", element, width, height));
    return ImageSize{width, height};
}

bool decode_webp(std::span<const uint8_t> bytes, TextureImage& image) {
    const int row_bytes = 4 * image.width;
    return WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(),
                              row_bytes) != nullptr;
}

bool decode_stb(std::span<const uint8_t> bytes, TextureImage& image) {
    int width = 0, height = 0, channels = 0;
    const auto release = [](stbi_uc* pixels) { stbi_image_free(pixels); };
    const std::unique_ptr<stbi_uc, decltype(release)> pixels(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                              &channels, 4),
        release);
    if (!pixels || width != image.width || height != image.height) return false;
    std::copy_n(pixels.get(), image.rgba.size(), image.rgba.begin());
    return true;
}

}  // namespace

ImageFormat image_format(std::span<const uint8_t> bytes) {
    static constexpr uint8_t kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static constexpr uint8_t kJpeg[] = {0xff, 0xd8, 0xff};
    static constexpr uint8_t kRiff[] = {'R', 'I', 'F', 'F'};
    static constexpr uint8_t kWebp[] = {'W', 'E', 'B', 'P'};
    if (starts_with(bytes, kPng)) return ImageFormat::png;
    if (starts_with(bytes, kJpeg)) return ImageFormat::jpeg;
    if (starts_with(bytes, kRiff) && starts_with(bytes, kWebp, 8)) return ImageFormat::webp;
    return ImageFormat::other;
}

Result<ImageSize> image_size(std::span<const uint8_t> bytes, const std::string& element) {
    int width = 0, height = 0, channels = 0;
    const ImageFormat format = image_format(bytes);
    // No other format reaches stb: glTF allows none, and stb's other decoders are the weaker ones.
    if (format == ImageFormat::other)
        return fail(bytes.empty() ? Errc::malformed : Errc::unsupported,
                    element + ": the image is neither PNG, JPEG nor WebP");
    if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
        return fail(Errc::unsupported, element + ": the image file exceeds 2 GiB");
    const bool read = format == ImageFormat::webp
                          ? WebPGetInfo(bytes.data(), bytes.size(), &width, &height) != 0
                          : stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()),
                                                  &width, &height, &channels) != 0;
    if (!read) return fail(Errc::malformed, element + ": the image does not decode");
    return check_size(width, height, element);
}

Result<TextureImage> decode_image(std::span<const uint8_t> bytes, const std::string& element) {
    AG_TRY(const ImageSize size, image_size(bytes, element));
    TextureImage image;
    image.width = size.width;
    image.height = size.height;
    try {
        image.rgba.resize(4 * static_cast<size_t>(size.width) * static_cast<size_t>(size.height));
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, element + ": no memory for the pixels");
    }
    const bool decoded = image_format(bytes) == ImageFormat::webp ? decode_webp(bytes, image)
                                                                  : decode_stb(bytes, image);
    if (!decoded) return fail(Errc::malformed, element + ": the image does not decode");
    return image;
}

}  // namespace aglow::gltf
