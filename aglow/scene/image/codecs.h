// SPDX-License-Identifier: Apache-2.0
// The file formats behind read_image() and write_image(), one pair of functions each. All work
// in memory and treat their input as untrusted.
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::image {

using Bytes = std::span<const uint8_t>;

/// No image that this project reads or writes has more; bounds what a forged header can ask for.
inline constexpr int64_t kMaxPixels = int64_t{1} << 28;

/// OpenEXR: scan lines or tiles, half, float or integer channels R, G, B or Y. The data window
/// becomes the image; primaries other than Rec. 709 are converted.
Result<Image> decode_exr(Bytes bytes);
Result<std::vector<uint8_t>> encode_exr(const Image& image);  ///< 32-bit float RGB, ZIP

/// Radiance RGBE, run-length coded or flat, in any of the eight orientations; divided by its
/// EXPOSURE lines.
/// Source  Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's color.c for the half-bit offset.
Result<Image> decode_radiance(Bytes bytes);
Result<std::vector<uint8_t>> encode_radiance(const Image& image);

/// PNG (8 or 16 bits) and JPEG, decoded from sRGB; alpha is dropped.
Result<Image> decode_srgb(Bytes bytes);
Result<std::vector<uint8_t>> encode_srgb_png(const Image& image);

}  // namespace aglow::image
