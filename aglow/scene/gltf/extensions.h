// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"

namespace aglow::gltf {

/// Refuses files that need what is not known here: a missing extension would give a wrong picture.
/// Errors  unsupported (names the extension, or the version of glTF), malformed.
Status check_requirements(const Json& root);

}  // namespace aglow::gltf
