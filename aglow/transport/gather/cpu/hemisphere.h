// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/cpu/embree_scene.h"
#include "aglow/core/random.h"
#include "aglow/shared/sampling.h"
#include "aglow/shared/sobol.h"
#include "aglow/transport/gather/cpu/direct_light.h"
#include "aglow/transport/gather/cpu/texel_map.h"

#include <algorithm>
#include <iterator>
#include <span>

namespace aglow::transport::cpu {

/// The random numbers of one receiver: stratified ones for its own samples, a plain stream for
/// the rare paths that go on behind a surface.
class Samples {
public:
    struct Draw {
        vec2 hemisphere;
        float point;  ///< which of the receiver's points: stratified together with the others
        vec3 emitter;
        vec2 sky;
    };
    Samples(uint64_t seed, uint32_t receiver, uint32_t purpose)
        : seed_(shared::hash_pair(
              shared::hash_pair(static_cast<uint32_t>(mix_bits(seed)), receiver), purpose)) {
        for (uint32_t i = 0; i < std::size(scramble_); ++i)
            scramble_[i] = shared::hash_pair(seed_, i);
    }
    /// Hemisphere, emitter and sky estimates are summed, so they may share coordinates.
    Draw draw(uint32_t i, bool with_sky) const {
        const shared::SobolPoint p = shared::sobol_point(i);
        Draw result;
        result.hemisphere = {shared::owen_scramble(p.x, scramble_[0]),
                             shared::owen_scramble(p.y, scramble_[1])};
        result.point = shared::owen_scramble(p.z, scramble_[2]);
        result.emitter = {shared::owen_scramble(p.w, scramble_[3]),
                          shared::owen_scramble(p.x, scramble_[4]),
                          shared::owen_scramble(p.y, scramble_[5])};
        result.sky = with_sky ? vec2{shared::owen_scramble(p.x, scramble_[6]),
                                     shared::owen_scramble(p.y, scramble_[7])}
                              : vec2{0, 0};
        return result;
    }
    Pcg32 path(uint32_t i) const { return Pcg32(seed_, i); }

private:
    uint32_t seed_;
    uint32_t scramble_[8];
};

/// A vantage and the frame about its normal.
struct Outlook {
    Vantage at;
    Frame frame;
    explicit Outlook(const Vantage& vantage) : at(vantage), frame(vantage.normal) {}
};

/// The outlook that a number in [0, 1) picks.
inline const Outlook& pick(std::span<const Outlook> outlooks, float u) {
    const auto i = static_cast<size_t>(u * static_cast<float>(outlooks.size()));
    return outlooks[std::min(i, outlooks.size() - 1)];
}

/// What a hemisphere ray finds, told to a visitor with three members:
///   direct(irradiance)           sky or emission seen from the receiver itself
///   texel(delay, element, w)     light of a texel, weighted by w, after `delay` path vertices
///   light(delay, exitance)       light that reached path vertex number `delay` (0: the first)
///   directly
/// Texels hold the light of fronts only. A ray that meets a back, or a front without a texel of
/// its own, goes on from there as a path until it finds a texel. At most `max_vertices` vertices
/// are followed; kUnlimited leaves the end to Russian roulette.
inline constexpr int kUnlimited = -1;

template <class Visitor>
void follow_path(const World& world, const TexelMap& map, accel::cpu::SurfaceHit hit, Pcg32 random,
                 int max_vertices, Visitor&& visitor, uint64_t& ray_count) {
    vec3 weight{1, 1, 1};
    for (int delay = 0; max_vertices == kUnlimited || delay < max_vertices; ++delay) {
        weight *= diffuse_reflectance(world.scene, world.surfaces, hit.at);
        const Vantage at = vantage_on(world.surfaces, hit.at, hit.front);
        const vec3 u_emitter{random.uniform(), random.uniform(), random.uniform()};
        const vec2 u_sky{random.uniform(), random.uniform()};
        visitor.light(delay, weight * (delta_irradiance(world, at, ray_count) +
                                       sampled_irradiance(world, at, u_emitter, u_sky, ray_count)));
        if (max_vertices == kUnlimited) {
            // Weights stay at or below 1, so that links pass on no more light than there is.
            const float survival = shared::max(weight.x, shared::max(weight.y, weight.z));
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
        const uint32_t element = hit.front ? map.element(hit.at) : kNoElement;
        if (element != kNoElement) {
            visitor.texel(delay + 1, element, weight);
            return;
        }
    }
}

/// Sends ray `i` of a receiver from one of its points and tells the visitor what it finds.
template <class Visitor>
void gather_ray(const World& world, const TexelMap& map, const Outlook& from,
                const Samples& samples, uint32_t i, vec2 u, int max_vertices, Visitor&& visitor,
                uint64_t& ray_count) {
    const Vantage& at = from.at;
    const vec3 direction = from.frame.to_world(shared::cosine_hemisphere(u));
    if (!(dot(direction, at.geometric_normal) > 0)) return;
    ++ray_count;
    accel::cpu::SurfaceHit hit;
    if (!world.rays.cpu().intersect(at.origin, direction, kInfinity, hit)) {
        visitor.direct(sky_seen(world, at, direction));
        return;
    }
    if (world.lights.has_emitters())
        visitor.direct(emission_seen(world, at, direction, hit.at, hit.front));
    const uint32_t element = hit.front ? map.element(hit.at) : kNoElement;
    if (element != kNoElement)
        visitor.texel(0, element, vec3{1, 1, 1});
    else
        follow_path(world, map, hit, samples.path(i), max_vertices, visitor, ray_count);
}

}  // namespace aglow::transport::cpu
