// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <string>
#include <vector>

namespace aglow::gltf {

/// Reads which heights a primitive's extras name (docs/formats/displacement.md); the file itself
/// stays unread. What does not follow the format, or leaves the folder, is left out with a warning.
void read_displacement_tag(const Json& json, Primitive& primitive,
                           std::vector<std::string>& warnings);

}  // namespace aglow::gltf
