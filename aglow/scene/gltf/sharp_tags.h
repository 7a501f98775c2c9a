// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <string>
#include <vector>

namespace aglow::gltf {

/// Reads the sharp edges and vertices that a primitive's extras name (docs/formats/creases.md)
/// into `primitive`, whose positions are those of the file. Extras are free for all: what does not
/// follow the format is left out with a warning.
void read_sharp_tags(const Json& json, Primitive& primitive, std::vector<std::string>& warnings);

}  // namespace aglow::gltf
