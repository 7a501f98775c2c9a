// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/direct_light.h"

#include "aglow/accel/cpu/embree_scene.h"
#include "aglow/core/assert.h"

#include <span>

namespace aglow::transport::cpu {
namespace {

/// Cosine at the receiver, 0 for directions below either of its planes.
float receiving_cosine(const Vantage& at, vec3 direction) {
    return dot(direction, at.geometric_normal) > 0 ? shared::max(0.0f, dot(direction, at.normal))
                                                   : 0.0f;
}

}  // namespace

Vantage vantage_on(const Surfaces& surfaces, SurfacePoint at, bool front) {
    const vec3 normal = geometric_normal(surfaces, at.triangle) * (front ? 1.0f : -1.0f);
    return {
        offset_origin(position(surfaces, at), normal, coordinate_magnitude(surfaces, at.triangle)),
        normal, normal};
}

vec3 delta_irradiance(const World& world, const Vantage& at, uint64_t& ray_count) {
    vec3 sum{0, 0, 0};
    for (size_t i = 0; i < world.lights.delta_count(); ++i) {
        const LightSample light = world.lights.delta(i, at.origin);
        const float cosine = receiving_cosine(at, light.direction);
        if (!(cosine > 0) || light.normal_irradiance == vec3{0, 0, 0}) continue;
        ++ray_count;
        sum += light.normal_irradiance *
               (cosine * world.rays.cpu().visibility(at.origin, light.direction, light.distance));
    }
    return sum;
}

void ShadowRays::add(const World& world, const Vantage& at, const EmittersSeen& emitters,
                     vec3 u_emitter, vec2 u_sky) {
    if (world.lights.has_emitters()) add(at, emitters.sample(u_emitter));
    if (world.lights.samples_sky()) add(at, world.lights.sky(u_sky));
}

void ShadowRays::add(const Vantage& at, const LightSample& light) {
    const float cosine = receiving_cosine(at, light.direction);
    if (!(cosine > 0) || light.normal_irradiance == vec3{0, 0, 0}) return;
    AG_ASSERT(count_ < kRoom, "no more than a batch of samples between traces");
    const float weight = light.pdf / (light.pdf + cosine / kPi);
    irradiance_[count_] = light.normal_irradiance * (cosine * weight);
    rays_[count_++] = {at.origin, light.direction, light.distance};
}

vec3 ShadowRays::trace(const World& world, uint64_t& ray_count) {
    float passing[kRoom];
    world.rays.cpu().visibility(std::span(rays_, count_), passing);
    vec3 sum{0, 0, 0};
    for (size_t i = 0; i < count_; ++i) sum += irradiance_[i] * passing[i];
    ray_count += count_;
    count_ = 0;
    return sum;
}

vec3 emission_seen(const World& world, const Vantage& at, const EmittersSeen& emitters,
                   vec3 direction, SurfacePoint hit, bool front) {
    const vec3 emission = world.lights.emitted(hit, front);
    if (emission == vec3{0, 0, 0}) return emission;
    const float pdf = shared::max(0.0f, dot(direction, at.normal)) / kPi;
    return emission * (kPi * pdf / (pdf + emitters.pdf(hit)));
}

vec3 sky_seen(const World& world, const Vantage& at, vec3 direction) {
    if (!world.lights.has_sky()) return {0, 0, 0};
    const vec3 irradiance = world.lights.sky_luminance(direction) * kPi;
    if (!world.lights.samples_sky()) return irradiance;
    const float pdf = shared::max(0.0f, dot(direction, at.normal)) / kPi;
    return irradiance * (pdf / (pdf + world.lights.sky_pdf(direction)));
}

}  // namespace aglow::transport::cpu
