// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/buffers.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/photometry.h"
#include "aglow/scene/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace aglow::gltf {

/// Errors  malformed (names the camera).
Result<std::vector<Camera>> read_cameras(const Json& root);

/// The lights of KHR_lights_punctual. Errors: malformed (names the light).
Result<std::vector<Light>> read_lights(const Json& root);

/// The luminaires of EXT_lights_ies.
struct LightProfiles {
    std::vector<std::vector<uint8_t>> files;  ///< [profile] empty where in a bufferView
    std::vector<std::shared_ptr<const Photometry>> photometries;
};
/// Errors  malformed, unreadable, unsupported (name the profile).
Result<LightProfiles> read_light_profiles(const Json& root, std::span<const BufferView> views,
                                          const std::filesystem::path& folder);

/// The light that a node makes of a profile, by its member EXT_lights_ies; none without one.
Result<std::optional<Light>> read_luminaire(const Json& node, const LightProfiles& profiles);

}  // namespace aglow::gltf
