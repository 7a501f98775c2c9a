// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/transport/irradiance.h"

namespace aglow::transport::cpu {

/// A point just above a surface from which rays start, and the plane its irradiance refers to.
struct Vantage {
    vec3 origin;
    vec3 normal;
    vec3 geometric_normal;
};

inline Vantage vantage_of(const Receiver& receiver) {
    return {offset_origin(receiver.position, receiver.geometric_normal, receiver.magnitude),
            receiver.normal, receiver.geometric_normal};
}

/// The vantage on one side of a surface, with the geometric normal of that side.
Vantage vantage_on(const Surfaces& surfaces, SurfacePoint at, bool front);

/// Irradiance from point, spot and directional lights. Adds the rays it traces to `ray_count`.
vec3 delta_irradiance(const World& world, const Vantage& at, uint64_t& ray_count);

/// One-sample estimates of the irradiance from emissive triangles and from a sky that is sampled by
/// luminance: the part of each that the balance heuristic does not leave to cosine-distributed
/// rays, which bring sky_seen() and emission_seen().
/// Source  Veach & Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
///         SIGGRAPH 1995.
vec3 sampled_irradiance(const World& world, const Vantage& at, vec3 u_emitter, vec2 u_sky,
                        uint64_t& ray_count);

/// Irradiance that a cosine-distributed ray from `at` along `direction` stands for, weighted by the
/// balance heuristic, where it leaves the scene ...
vec3 sky_seen(const World& world, const Vantage& at, vec3 direction);
/// ... and where it meets an emissive surface.
vec3 emission_seen(const World& world, const Vantage& at, vec3 direction, SurfacePoint hit,
                   bool front);

}  // namespace aglow::transport::cpu
