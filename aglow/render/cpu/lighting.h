// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/cpu/surface.h"
#include "aglow/render/tables/tables.h"
#include "aglow/scene/punctual_lights.h"

#include <vector>

namespace aglow::render::cpu {

/// What all frames of a scene share.
struct SharedTables {
    MaterialTable materials;
    EmitterTable emitters;  ///< empty where light is baked
    SkyTable sky;           ///< likewise
    std::vector<vec2> offsets;
    uint32_t seed = 0;
};

/// Light that a lightmap holds.
struct StoredLight {
    const Image* irradiance = nullptr;  ///< null: none
    bool has_punctual = true;           ///< the direct light of punctual lights is in it
};

/// A scene at one time, and how it is lit.
struct World {
    const Scene& scene;
    const Surfaces& surfaces;
    const RayScene& rays;
    const SharedTables& tables;
    StoredLight stored;
    std::vector<PlacedLight> lights;  ///< where they are at that time

    bool baked() const { return stored.irradiance != nullptr; }
};

/// What the numbers that light is sampled by depend on.
struct Draw {
    uint32_t pixel, sample, depth;
};

/// Light that reaches one side of a surface: the front where it is baked, else that of the viewer.
struct Incoming {
    vec3 irradiance = {0, 0, 0};  ///< E, lux
    vec3 mean = {0, 0, 0};        ///< E without the direct light of punctual lights, lux
    vec3 highlight = {0, 0, 0};   ///< what these show towards the viewer, cd/m^2
};

/// Which highlights to look for.
struct Gloss {
    bool wanted = false;
    uint32_t kind = shared::kHighlightGgx;
    vec3 f0 = {0, 0, 0};
    float alpha = 1;
    vec3 to_viewer = {0, 0, 1};
};

/// Adds the shadow rays it traces to `ray_count`.
Incoming incoming_light(const World& world, const Surface& surface, const Gloss& gloss, Draw draw,
                        uint64_t& ray_count);

/// Luminance of the sky: bilinear between pixels, wrapped around the horizon.
vec3 sky_luminance(const Scene& scene, vec3 direction);

/// Irradiance that the lightmap holds, lux.
vec3 baked_irradiance(const Surfaces& surfaces, const Image& irradiance, SurfacePoint at);

}  // namespace aglow::render::cpu
