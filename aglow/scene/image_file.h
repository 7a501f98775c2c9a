// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace aglow {

/// Reads .exr, .hdr (Radiance RGBE), .png or .jpg by content as linear Rec. 709; PNG and JPEG are
/// decoded from sRGB.
/// Errors  unreadable, malformed (names the file), out_of_memory.
Result<Image> read_image(const std::filesystem::path& path);

/// Writes by ending: .exr (32-bit float, RGB), .hdr, .png (8-bit sRGB, clipped at 1). Atomic.
/// Errors  unreadable (cannot write), bad_argument (other ending).
Status write_image(const Image& image, const std::filesystem::path& path);

/// PNG bytes of 8-bit RGBA or RGB.
std::vector<uint8_t> encode_png(std::span<const uint8_t> pixels, int width, int height,
                                int channels);

}  // namespace aglow
