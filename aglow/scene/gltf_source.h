// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aglow {

/// A glTF file as it was read: the JSON text and the bytes of every buffer (after resolving
/// data: URIs, files and the GLB chunk) and of every image (encoded: PNG, JPEG, WebP, ...).
/// Fallback buffers of EXT_meshopt_compression hold what their views decompress to: whoever drops
/// that extension from the text has a valid file.
struct GltfSource {
    std::string json;
    /// [buffers.length] byteLength bytes each; a fallback buffer ends with its last view.
    std::vector<std::vector<uint8_t>> buffers;
    std::vector<std::vector<uint8_t>>
        images;  ///< [images.length]; empty where in a bufferView or missing
    std::vector<std::vector<uint8_t>> light_profiles;  ///< [lights of EXT_lights_ies]; as images
    std::filesystem::path folder;                      ///< where relative URIs start
};

}  // namespace aglow
