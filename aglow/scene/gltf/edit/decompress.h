// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/elements.h"

#include <map>

namespace aglow::gltf::edit {

/// Makes every bufferView compressed by EXT_meshopt_compression a plain one. Loading has put the
/// decoded bytes where the views point, so that only the extension has to go.
void drop_meshopt(Document& document);

/// The attributes of a primitive that KHR_draco_mesh_compression compresses, by name, in the types
/// that their accessors declare.
/// Errors  malformed.
Result<std::map<std::string, Elements>> decode_draco(const Document& document,
                                                     const Json& primitive);

}  // namespace aglow::gltf::edit
