// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"
#include "aglow/scene/gltf/edit/output_set.h"

namespace aglow::gltf::edit {

/// Where a document goes: a .glb that stands alone, or a .gltf with its buffer beside it.
struct SceneFiles {
    std::filesystem::path scene;
    std::filesystem::path buffer;  ///< of a .gltf
    bool binary = true;            ///< .glb
};

/// Errors  bad_argument  another ending than .glb or .gltf
Result<SceneFiles> scene_files(const std::filesystem::path& path);

/// Adds the scene's own files, first the scene, then what it names.
/// Errors  bad_argument (more than 4 GiB in a .glb), those of OutputSet::add().
Status add_scene(Document& document, const SceneFiles& files, OutputSet& outputs);

/// A neighbour of the input must not be lost to an output that happens to share its name.
/// Errors  bad_argument  the buffer or one of `others` is a file that the input names
Status protect_input(const Scene& scene, const Document& document, const SceneFiles& files,
                     const std::vector<std::filesystem::path>& others);

std::span<const uint8_t> bytes_of(const std::string& text);

}  // namespace aglow::gltf::edit
