// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <span>
#include <string>

namespace aglow::gltf {

enum class ImageFormat { png, jpeg, webp, other };

/// Told from the first bytes; names and media types may lie.
ImageFormat image_format(std::span<const uint8_t> bytes);

struct ImageSize {
    int width = 0;
    int height = 0;
};

/// Size from the header alone, before memory for the pixels is asked for.
/// Errors  malformed, unsupported (no PNG, JPEG or WebP; or more than 2^28 pixels);
///         the message starts with `element`.
Result<ImageSize> image_size(std::span<const uint8_t> bytes, const std::string& element);

/// Decodes to 8-bit RGBA. Errors: as above, and out_of_memory.
Result<TextureImage> decode_image(std::span<const uint8_t> bytes, const std::string& element);

}  // namespace aglow::gltf
