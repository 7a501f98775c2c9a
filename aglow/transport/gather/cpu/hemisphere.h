// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/cpu/embree_scene.h"
#include "aglow/core/random.h"
#include "aglow/shared/sampling.h"
#include "aglow/shared/sobol.h"
#include "aglow/transport/gather/cpu/direct_light.h"
#include "aglow/transport/gather/cpu/texel_map.h"

namespace aglow::transport::cpu {

/// The random numbers of one receiver: stratified ones for its own samples, a plain stream for
/// the rare paths that go on behind a surface.
class Samples {
public:
    Samples(uint64_t seed, uint32_t receiver, uint32_t purpose)
        : seed_(shared::hash_pair(
              shared::hash_pair(static_cast<uint32_t>(mix_bits(seed)), receiver), purpose)) {}
    vec2 hemisphere(uint32_t i) const {
        return shared::owen_sobol_2d(i, shared::hash_pair(seed_, 1));
    }
    vec3 emitter(uint32_t i) const { return shared::owen_sobol_3d(i, shared::hash_pair(seed_, 2)); }
    vec2 sky(uint32_t i) const { return shared::owen_sobol_2d(i, shared::hash_pair(seed_, 3)); }
    Pcg32 path(uint32_t i) const { return Pcg32(seed_, i); }

private:
    uint32_t seed_;
};

/// What a hemisphere ray finds, told to a visitor with three members:
///   direct(irradiance)           sky or emission seen from the receiver itself
///   texel(delay, element, w)     light of a texel's front, weighted by w, after `delay` backs
///   light(delay, exitance)       light that reached back number `delay` (0: the first) directly
/// Texels hold the light of fronts only, so a ray that meets a back goes on as a path until it
/// finds a front. At most `max_backs` backs are followed; kUnlimited leaves the end to Russian
/// roulette.
inline constexpr int kUnlimited = -1;

template <class Visitor>
void follow_backs(const World& world, const TexelMap& map, accel::cpu::SurfaceHit hit, Pcg32 random,
                  int max_backs, Visitor&& visitor, uint64_t& ray_count) {
    vec3 weight{1, 1, 1};
    for (int delay = 0; max_backs == kUnlimited || delay < max_backs; ++delay) {
        weight *= diffuse_reflectance(world.scene, world.surfaces, hit.at);
        const Vantage at = vantage_on(world.surfaces, hit.at, false);
        const vec3 u_emitter{random.uniform(), random.uniform(), random.uniform()};
        const vec2 u_sky{random.uniform(), random.uniform()};
        visitor.light(delay, weight * (delta_irradiance(world, at, ray_count) +
                                       sampled_irradiance(world, at, u_emitter, u_sky, ray_count)));
        if (max_backs == kUnlimited) {
            const float survival =
                shared::min(0.95f, shared::max(weight.x, shared::max(weight.y, weight.z)));
            if (!(random.uniform() < survival)) return;
            weight *= 1 / survival;
        }
        const vec2 u{random.uniform(), random.uniform()};
        const vec3 direction = Frame(at.normal).to_world(shared::cosine_hemisphere(u));
        ++ray_count;
        if (!world.rays.cpu().intersect(at.origin, direction, kInfinity, hit)) {
            visitor.light(delay, weight * sky_seen(world, at, direction));
            return;
        }
        if (world.lights.has_emitters())
            visitor.light(delay, weight * emission_seen(world, at, direction, hit.at, hit.front));
        if (hit.front) {
            const uint32_t element = map.element(hit.at);
            if (element != kNoElement) visitor.texel(delay + 1, element, weight);
            return;
        }
    }
}

/// Sends ray `i` of a receiver and tells the visitor what it finds.
template <class Visitor>
void gather_ray(const World& world, const TexelMap& map, const Vantage& at, const Frame& frame,
                const Samples& samples, uint32_t i, int max_backs, Visitor&& visitor,
                uint64_t& ray_count) {
    const vec3 direction = frame.to_world(shared::cosine_hemisphere(samples.hemisphere(i)));
    if (!(dot(direction, at.geometric_normal) > 0)) return;
    ++ray_count;
    accel::cpu::SurfaceHit hit;
    if (!world.rays.cpu().intersect(at.origin, direction, kInfinity, hit)) {
        visitor.direct(sky_seen(world, at, direction));
        return;
    }
    if (world.lights.has_emitters())
        visitor.direct(emission_seen(world, at, direction, hit.at, hit.front));
    if (hit.front) {
        const uint32_t element = map.element(hit.at);
        if (element != kNoElement) visitor.texel(0, element, vec3{1, 1, 1});
    } else {
        follow_backs(world, map, hit, samples.path(i), max_backs, visitor, ray_count);
    }
}

}  // namespace aglow::transport::cpu
