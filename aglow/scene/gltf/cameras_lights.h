// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <vector>

namespace aglow::gltf {

/// Errors  malformed (names the camera).
Result<std::vector<Camera>> read_cameras(const Json& root);

/// The lights of KHR_lights_punctual. Errors: malformed (names the light).
Result<std::vector<Light>> read_lights(const Json& root);

}  // namespace aglow::gltf
