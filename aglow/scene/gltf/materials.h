// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <span>
#include <string>
#include <vector>

namespace aglow::gltf {

/// What light needs of every material. Repairs (numbers out of range, textures without an image)
/// and reflectances that will be clamped are told in `warnings`.
/// Errors  malformed, unsupported (a texture's image is only in a format that is not known here).
Result<std::vector<Material>> read_materials(const Json& root, std::span<const Texture> textures,
                                             std::vector<std::string>& warnings);

/// Warns of materials whose base color * (1 - metallic) exceeds what surfaces clamp it to, with
/// the textures taken into account. The scene's images are decoded.
/// Cost  O(pixels of base color textures).
void warn_of_reflectance(Scene& scene);

}  // namespace aglow::gltf
