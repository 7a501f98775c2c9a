// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"
#include "aglow/shared/light.h"

#include <span>
#include <vector>

namespace aglow {

/// A light without extent where its node puts it.
struct PlacedLight {
    shared::PunctualLight light;             ///< photometry, gamma_count and c_count are 0
    const Photometry* photometry = nullptr;  ///< of a photometric light
};

/// Those of the active scene, in the order of their nodes; dark ones are left out.
/// `transforms` are world_transforms() at some time.
std::vector<PlacedLight> punctual_lights(const Scene& scene, std::span<const mat4> transforms);

/// What reaches `p` from the light, its photometry included.
shared::LightArrival arrival(const PlacedLight& light, vec3 p);

}  // namespace aglow
