// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/render/tables/tables.h"
#include "aglow/shared/camera.h"
#include "aglow/shared/shading.h"

#include <array>
#include <vector>

namespace aglow::render::cpu {

/// RGBA of a texture at a fractional mip level: bilinear within levels, linear between them; the
/// full resolution is blended as the sampler says. Alpha is linear.
vec4 sample_texture(const MaterialTable& table, uint32_t texture, vec2 st, float level);

/// What a ray met.
struct Surface {
    SurfacePoint at;
    bool front = true;   ///< the side that the ray came from
    uint32_t flags = 0;  ///< of its material, shared::kMaterial...
    vec3 position;
    vec3 geometric_normal, normal;  ///< unit, towards the front; the second interpolated
    shared::Triangle corners;
    std::array<vec3, 3> normals;  ///< of the corners
    float magnitude = 0;          ///< see coordinate_magnitude()
    float curvature = 0;          ///< 1/m, positive where the side that the ray sees is convex
    shared::SurfaceColor color;

    float side() const { return front ? 1.0f : -1.0f; }
    /// Where shadow rays start that leave on the front (1) or back (-1).
    vec3 shadow_origin(float side) const;
};

/// `cone` is the ray's where it meets the surface.
Surface surface_at(const Surfaces& surfaces, const MaterialTable& table, const Hit& hit,
                   vec3 direction, const shared::RayCone& cone);

}  // namespace aglow::render::cpu
