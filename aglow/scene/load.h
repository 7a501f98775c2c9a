// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace aglow {

/// Loads .gltf, .glb or .obj (with its .mtl) by content, not by ending. The file is untrusted:
/// every index, size, offset, URI and number is checked before use.
/// Result  what could be repaired or ignored is in Scene::warnings.
/// Errors  unreadable   the file or one it names is missing, or its URI leaves the folder
///         malformed    it breaks the format; the message names the element
///         unsupported  extensionsRequired names an extension that is not known here
/// Cost    O(size of the file and the files it names); all vertices and images are in memory.
Result<Scene> load_scene(const std::filesystem::path& path);

/// The same for a glTF or GLB file in memory. URIs are looked up in `folder`; an empty folder
/// allows data: URIs only.
Result<Scene> load_gltf(std::span<const std::byte> bytes, const std::string& name,
                        const std::filesystem::path& folder);

}  // namespace aglow
