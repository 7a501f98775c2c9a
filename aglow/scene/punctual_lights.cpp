// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/punctual_lights.h"

#include "aglow/scene/photometry.h"

#include <cmath>

namespace aglow {
namespace {

uint32_t shared_kind(LightKind kind) {
    switch (kind) {
        case LightKind::spot:
            return shared::kLightSpot;
        case LightKind::directional:
            return shared::kLightDirectional;
        case LightKind::photometric:
            return shared::kLightPhotometric;
        case LightKind::point:
            break;
    }
    return shared::kLightPoint;
}

/// The node's scale does not count, but a mirror turns the C angles the other way round.
PlacedLight placed(const Light& light, const mat4& to_world) {
    PlacedLight result{};
    shared::PunctualLight& l = result.light;
    l.kind = shared_kind(light.kind);
    l.position = transform_point(to_world, {0, 0, 0});
    l.axis = normalize(transform_direction(to_world, {0, 0, -1}));
    l.right = {1, 0, 0};
    l.up = {0, 1, 0};
    l.intensity = light.intensity;
    l.cone_offset = 1;
    if (light.kind == LightKind::spot) {
        // KHR_lights_punctual, inner and outer cone angles.
        const float cos_inner = std::cos(light.inner_cone), cos_outer = std::cos(light.outer_cone);
        l.cone_scale = 1 / std::max(0.001f, cos_inner - cos_outer);
        l.cone_offset = -cos_outer * l.cone_scale;
    }
    if (light.kind == LightKind::photometric) {
        result.photometry = light.photometry.get();
        l.right = normalize(transform_direction(to_world, {1, 0, 0}));
        l.up = normalize(transform_direction(to_world, {0, 1, 0}));
    }
    return result;
}

}  // namespace

std::vector<PlacedLight> punctual_lights(const Scene& scene, std::span<const mat4> transforms) {
    std::vector<PlacedLight> lights;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.in_scene || node.light < 0) continue;
        const Light& light = scene.lights[static_cast<size_t>(node.light)];
        if (luminance(light.intensity) > 0) lights.push_back(placed(light, transforms[i]));
    }
    return lights;
}

shared::LightArrival arrival(const PlacedLight& placed, vec3 p) {
    shared::LightArrival result = shared::punctual_arrival(placed.light, p);
    if (placed.photometry)
        result.normal_irradiance *= intensity(
            *placed.photometry, shared::photometric_direction(placed.light, result.direction));
    return result;
}

}  // namespace aglow
