// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/mesh/surfaces.h"

#include <memory>
#include <vector>

namespace aglow {

namespace transport {
class Emitters;
}

/// Unoccluded light that reaches a point from one sampled direction.
struct LightSample {
    vec3 direction = {0, 0, 0};  ///< unit, from the point towards the light
    float distance = 0;          ///< m that have to be free; kInfinity for sky and sun
    /// Irradiance on a plane that faces `direction`, lux, divided by the probability of the
    /// sample: multiply by max(0, n . direction) and by visibility. Zero where nothing was found.
    vec3 normal_irradiance = {0, 0, 0};
    float pdf = 0;  ///< of the direction, 1/sr; 0 for delta lights
};

/// The light formulas: all that emits in a scene, and how to sample it. Three kinds, sampled apart:
/// delta lights (point, spot, directional, luminaires with photometry) are few and evaluated one by
/// one; emissive triangles are drawn from a light tree; the sky by its luminance.
/// Units  lux, cd/m^2, candela.   Thread safety  const members from any thread.
class Lights {
public:
    /// Keeps references to `scene` and `surfaces`. `transforms` are world_transforms() at the time
    /// of the pose.
    Lights(const Scene& scene, const Surfaces& surfaces, const std::vector<mat4>& transforms);
    Lights(Lights&&) noexcept;
    ~Lights();

    /// Lights without extent: the i-th seen from `p`.
    size_t delta_count() const;
    LightSample delta(size_t i, vec3 p) const;

    /// Emissive triangles; kernels sample them by transport::EmittersSeen.
    bool has_emitters() const;
    const transport::Emitters& emitters() const;
    /// Luminance that leaves a hit emissive surface towards a ray that arrives on its front
    /// (`front`) or back. Alpha is not in it: it is the probability of the hit.
    vec3 emitted(const SurfacePoint& at, bool front) const;

    /// Sky: a direction by luminance. has_sky() is false where it is black; samples_sky() is false
    /// for a uniform sky, which cosine-distributed rays sample best.
    bool has_sky() const;
    bool samples_sky() const;
    LightSample sky(vec2 u) const;
    vec3 sky_luminance(vec3 direction) const;  ///< cd/m^2
    float sky_pdf(
        vec3 direction) const;  ///< 1/sr with which sky() draws it; 0 unless samples_sky()

    bool dark() const;  ///< nothing emits at all

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace aglow
