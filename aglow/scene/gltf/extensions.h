// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"

#include <string>
#include <vector>

namespace aglow::gltf {

/// Refuses files that need what is not known here: a missing extension would give a wrong picture.
/// Warns of light that a file has only where an extension is known.
/// Errors  unsupported (names the extension, or the version of glTF), malformed.
Status check_requirements(const Json& root, std::vector<std::string>& warnings);

}  // namespace aglow::gltf
