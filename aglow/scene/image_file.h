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
/// decoded from sRGB. Every value of the result is finite. EXR: half, float or integer R, G, B or
/// Y, primaries other than Rec. 709 converted; Radiance: divided by its EXPOSURE.
/// Errors  unreadable, malformed (also a NaN or infinite pixel), unsupported (a rare coding),
///         out_of_memory; all name the file.
Result<Image> read_image(const std::filesystem::path& path);

/// The same from memory; errors name no file.
Result<Image> decode_image(std::span<const uint8_t> bytes);

/// Writes by ending: .exr (32-bit float, RGB), .hdr, .png (8-bit sRGB, clipped at 1). Atomic.
/// Errors  unreadable (cannot write), bad_argument (other ending, no pixels), out_of_memory.
Status write_image(const Image& image, const std::filesystem::path& path);

/// PNG bytes of 8-bit grey, grey and alpha, RGB or RGBA pixels.
/// Shapes  pixels has height * width * channels entries, row 0 on top.
/// Result  empty where memory runs out.
std::vector<uint8_t> encode_png(std::span<const uint8_t> pixels, int width, int height,
                                int channels);

}  // namespace aglow
