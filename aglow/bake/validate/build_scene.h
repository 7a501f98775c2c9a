// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/scene/scene.h"
#include "aglow/transport/irradiance.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

/// Small scenes made by code, as plain Scene values.
namespace aglow::validation {

enum class Sides : uint8_t { one, two };
enum class Facing : uint8_t { inwards, outwards };

/// A diffuse material that reflects `rho` and emits `luminance` (cd/m^2) from its front, or from
/// both sides. Returns its index.
int add_material(Scene& scene, vec3 rho, vec3 luminance = {0, 0, 0}, Sides sides = Sides::one);
inline int add_grey(Scene& scene, float rho, float luminance = 0) {
    return add_material(scene, {rho, rho, rho}, {luminance, luminance, luminance});
}

/// The parallelogram corner, corner + u, corner + u + v, corner + v as a node with a mesh of its
/// own; its front is on the side of cross(u, v). Returns the node's index.
int add_rectangle(Scene& scene, int material, vec3 corner, vec3 u, vec3 v);

/// An axis-aligned box as one node; its six faces show their fronts inwards or outwards.
int add_box(Scene& scene, int material, vec3 lo, vec3 hi, Facing facing);

/// A light at `position` that shines along `direction` (unit).
void add_light(Scene& scene, Light light, vec3 position, vec3 direction = {0, -1, 0});

/// Sky image of `height` rows and twice as many columns; `luminance_of` gets the direction (unit)
/// in which a pixel's centre lies.
template <class Function>
Sky image_sky(int height, const Function& luminance_of) {
    auto image = std::make_shared<Image>(2 * height, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const float elevation =
                aglow::kPi * (0.5f - (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
            // The centre column shows north, -Z; columns to its right show east, +X.
            const float azimuth =
                aglow::kPi * ((static_cast<float>(x) + 0.5f) / static_cast<float>(height) - 1);
            const float flat = std::cos(elevation);
            image->at(x, y) = luminance_of(
                vec3{flat * std::sin(azimuth), std::sin(elevation), -flat * std::cos(azimuth)});
        }
    return Sky{.luminance = {1, 1, 1}, .image = std::move(image)};
}

/// The same scene with every length multiplied by `scale` and point and spot lights by its square:
/// illuminance stays as it is, flux grows with the area.
void scale_scene(Scene& scene, double scale);

/// A sensor in the open.
Receiver sensor(vec3 position, vec3 normal);

}  // namespace aglow::validation
