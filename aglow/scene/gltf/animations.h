// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

namespace aglow::gltf {

/// Number of skins, which nodes refer to before skins can be read.
Result<size_t> count_skins(const Json& root);

/// Reads the skins into `scene`, whose nodes and meshes are read already, and checks that every
/// joint number that a skinned mesh uses exists.
/// Errors  malformed (names skin or node), out_of_memory.
Status read_skins(const Json& root, Accessors& accessors, Scene& scene);

/// Reads the animations into `scene`. Channels that aim at no node, or by KHR_animation_pointer at
/// other properties, do not move surfaces and are left out.
/// Errors  malformed (names animation, channel and accessor), out_of_memory.
Status read_animations(const Json& root, Accessors& accessors, Scene& scene);

}  // namespace aglow::gltf
