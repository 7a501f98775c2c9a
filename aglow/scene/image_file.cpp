// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/image_file.h"

#include "aglow/core/file.h"
#include "aglow/scene/image/codecs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <string_view>

namespace aglow {
namespace {

bool starts_with(image::Bytes bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char m, uint8_t b) { return static_cast<uint8_t>(m) == b; });
}

Result<Image> decode(image::Bytes bytes) {
    if (starts_with(bytes, "\x76\x2f\x31\x01")) return image::decode_exr(bytes);
    if (starts_with(bytes, "#?")) return image::decode_radiance(bytes);
    if (starts_with(bytes, "\x89PNG") || starts_with(bytes, "\xff\xd8"))
        return image::decode_srgb(bytes);
    return fail(Errc::malformed, "is none of the images known here: EXR, Radiance HDR, PNG, JPEG");
}

/// One NaN in a sky or a lightmap would spread over all that it lights.
Status check_finite(const Image& image) {
    const auto finite = [](vec3 c) {
        return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    };
    const auto bad = std::find_if_not(image.pixels.begin(), image.pixels.end(), finite);
    if (bad == image.pixels.end()) return {};
    const auto index = bad - image.pixels.begin();
    return fail(Errc::malformed, fmt::format("pixel ({}, {}) is not finite", index % image.width,
                                             index / image.width));
}

std::string lower_case_ending(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

Result<std::vector<uint8_t>> encode(const Image& image, const std::string& ending) {
    if (ending == ".exr") return image::encode_exr(image);
    if (ending == ".hdr") return image::encode_radiance(image);
    if (ending == ".png") return image::encode_srgb_png(image);
    return fail(Errc::bad_argument,
                fmt::format("images end in .exr, .hdr or .png, not \"{}\"", ending));
}

}  // namespace

Result<Image> decode_image(std::span<const uint8_t> bytes) {
    try {
        AG_TRY(Image image, decode(bytes));
        AG_CHECK(check_finite(image));
        return image;
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the image does not fit into memory");
    }
}

Result<Image> read_image(const std::filesystem::path& path) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    Result<Image> image = decode_image(bytes);
    if (!image) image.error().context = path.string();
    return image;
}

Status write_image(const Image& image, const std::filesystem::path& path) {
    try {
        Result<std::vector<uint8_t>> bytes = encode(image, lower_case_ending(path));
        if (!bytes) {
            bytes.error().context = path.string();
            return tl::unexpected<Error>(std::move(bytes).error());
        }
        return write_file(path, *bytes);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the image does not fit into memory", path.string());
    }
}

}  // namespace aglow
