// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/transport/gather/cpu/samples.h"
#include "aglow/transport/irradiance.h"
#include "aglow/transport/lights/emitters.h"

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

/// Shadow rays that are traced together, with the irradiance that each lets through.
class ShadowRays {
public:
    /// Adds one-sample estimates of the irradiance from emissive triangles and from a sky that is
    /// sampled by luminance: the part of each that the balance heuristic does not leave to
    /// cosine-distributed rays, which bring sky_seen() and emission_seen().
    /// At most kBatch times between calls of trace().
    /// Source  Veach & Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
    ///         SIGGRAPH 1995.
    void add(const World& world, const Vantage& at, const EmittersSeen& emitters, vec3 u_emitter,
             vec2 u_sky);

    /// The sum of what arrives; forgets the rays.
    vec3 trace(const World& world, uint64_t& ray_count);

private:
    void add(const Vantage& at, const LightSample& light);

    static constexpr size_t kRoom = 2 * kBatch;
    Ray rays_[kRoom];
    vec3 irradiance_[kRoom];
    size_t count_ = 0;
};

/// Irradiance that a cosine-distributed ray from `at` along `direction` stands for, weighted by the
/// balance heuristic, where it leaves the scene ...
vec3 sky_seen(const World& world, const Vantage& at, vec3 direction);
/// ... and where it meets an emissive surface.
vec3 emission_seen(const World& world, const Vantage& at, const EmittersSeen& emitters,
                   vec3 direction, SurfacePoint hit, bool front);

}  // namespace aglow::transport::cpu
