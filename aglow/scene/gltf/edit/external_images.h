// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"

namespace aglow::gltf::edit {

/// An image file that a .gltf names and that has to be put beside it.
struct ImageCopy {
    std::filesystem::path target;
    std::span<const uint8_t> bytes;  ///< of the document's source
};

/// Finds the images that `scene` (a .gltf to be written) would not find where its URIs look: they
/// keep their relative path, unless a file with other content is there already; then they get a
/// name of their own beside the scene.
std::vector<ImageCopy> relocate_images(Document& document, const std::filesystem::path& scene);

}  // namespace aglow::gltf::edit
