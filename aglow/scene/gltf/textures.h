// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/buffers.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace aglow::gltf {

/// The encoded images of a file.
struct EncodedImages {
    std::vector<std::vector<uint8_t>> files;      ///< [image] from URIs; empty where in a view
    std::vector<std::span<const uint8_t>> bytes;  ///< [image] into `files` or buffer views
    std::vector<std::string> elements;            ///< [image] `image 3 "wood"`
    std::vector<std::string> names;               ///< [image]
};

/// Reads every image's file or buffer view, without decoding.
/// Errors  malformed, unreadable (missing file; names the image).
Result<EncodedImages> read_images(const Json& root, std::span<const BufferView> views,
                                  const std::filesystem::path& folder);

/// Textures with their samplers. EXT_texture_webp's image is taken where there is one; a texture
/// whose only image is in a format no decoder here knows has image -1.
Result<std::vector<Texture>> read_textures(const Json& root, const EncodedImages& images);

/// Decodes the images that the materials use; the others keep 0 x 0 pixels.
/// Errors  malformed, unsupported, out_of_memory; the message names the image.
Result<std::vector<TextureImage>> decode_used_images(const EncodedImages& images,
                                                     std::span<const Texture> textures,
                                                     std::span<const Material> materials);

}  // namespace aglow::gltf
