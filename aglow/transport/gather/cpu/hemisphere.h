// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/cpu/embree_scene.h"
#include "aglow/shared/sampling.h"
#include "aglow/transport/gather/cpu/direct_light.h"
#include "aglow/transport/gather/cpu/samples.h"
#include "aglow/transport/gather/cpu/texel_map.h"

#include <algorithm>
#include <span>

namespace aglow::transport::cpu {

/// A vantage, the frame about its normal and what emits as seen from there.
struct Outlook {
    Vantage at;
    Frame frame;
    EmittersSeen emitters;
    Outlook(const World& world, const Vantage& vantage)
        : at(vantage),
          frame(vantage.normal),
          emitters(world.lights.emitters(), vantage.origin, vantage.normal) {}
};

/// The outlook that a number in [0, 1) picks.
inline const Outlook& pick(std::span<const Outlook> outlooks, float u) {
    const auto i = static_cast<size_t>(u * static_cast<float>(outlooks.size()));
    return outlooks[std::min(i, outlooks.size() - 1)];
}

inline constexpr int kUnlimited = -1;

/// What all rays of one receiver share.
struct Gathering {
    const World& world;
    const TexelMap& map;
    const Samples& samples;
    std::span<const Outlook> outlooks;
    int max_vertices;  ///< of a path; kUnlimited leaves its end to Russian roulette
    uint64_t& ray_count;

    uint32_t element(const accel::cpu::SurfaceHit& hit) const {
        return hit.front ? map.element(hit.at) : kNoElement;
    }
};

// What rays find is told to a visitor with four members:
//   ray(i)                       what follows is of sample i
//   direct(irradiance)           light that arrives at the receiver from what emits
//   texel(delay, element, w)     light of a texel, weighted by w, after `delay` path vertices
//   light(delay, exitance)       light that reached path vertex number `delay` (0: the first)
//                                directly

/// Texels hold the light of fronts only. A ray that met a back, or a front without a texel of its
/// own, goes on from there as a path until it finds a texel.
template <class Visitor>
void follow_path(const Gathering& g, accel::cpu::SurfaceHit hit, Pcg32 random, Visitor&& visitor) {
    const World& world = g.world;
    ShadowRays shadows;
    vec3 weight{1, 1, 1};
    for (int delay = 0; g.max_vertices == kUnlimited || delay < g.max_vertices; ++delay) {
        weight *= diffuse_reflectance(world.scene, world.surfaces, hit.at);
        const Outlook from(world, vantage_on(world.surfaces, hit.at, hit.front));
        const Vantage& at = from.at;
        const vec3 u_emitter{random.uniform(), random.uniform(), random.uniform()};
        const vec2 u_sky{random.uniform(), random.uniform()};
        shadows.add(world, at, from.emitters, u_emitter, u_sky);
        const vec3 delta = delta_irradiance(world, at, g.ray_count);
        visitor.light(delay, weight * (delta + shadows.trace(world, g.ray_count)));
        if (g.max_vertices == kUnlimited) {
            // Weights stay at or below 1, so that links pass on no more light than there is.
            const float survival = shared::max(weight.x, shared::max(weight.y, weight.z));
            if (!(random.uniform() < survival)) return;
            weight *= 1 / survival;
        }
        const vec2 u{random.uniform(), random.uniform()};
        const vec3 direction = from.frame.to_world(shared::cosine_hemisphere(u));
        ++g.ray_count;
        if (!world.rays.cpu().intersect(at.origin, direction, kInfinity, hit)) {
            visitor.light(delay, weight * sky_seen(world, at, direction));
            return;
        }
        visitor.light(
            delay, weight * emission_seen(world, at, from.emitters, direction, hit.at, hit.front));
        if (const uint32_t element = g.element(hit); element != kNoElement) {
            visitor.texel(delay + 1, element, weight);
            return;
        }
    }
}

/// Takes samples [first, first + count) of a receiver, `count` up to kBatch: samples what emits,
/// and, if it `looks_around`, sends rays over the hemisphere; tells the visitor what they find.
template <class Visitor>
void gather_batch(const Gathering& g, uint32_t first, uint32_t count, bool looks_around,
                  Visitor&& visitor) {
    Draws draws;
    g.samples.draw(first, draws);
    ShadowRays shadows;
    Ray rays[kBatch];
    struct {
        uint32_t sample;
        const Outlook* outlook;
    } origins[kBatch];
    uint32_t ray_total = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const Outlook& from = pick(g.outlooks, draws.values[Draws::point][i]);
        shadows.add(g.world, from.at, from.emitters, draws.emitter(i), draws.sky(i));
        if (!looks_around) continue;
        const vec3 direction = from.frame.to_world(shared::cosine_hemisphere(draws.hemisphere(i)));
        if (!(dot(direction, from.at.geometric_normal) > 0)) continue;
        rays[ray_total] = {from.at.origin, direction};
        origins[ray_total++] = {first + i, &from};
    }
    visitor.direct(shadows.trace(g.world, g.ray_count));

    accel::cpu::SurfaceHit hits[kBatch];
    g.world.rays.cpu().intersect(std::span(rays, ray_total), hits);
    g.ray_count += ray_total;
    // Texels are all over memory: looked up side by side, they are waited for together.
    uint32_t elements[kBatch];
    for (uint32_t k = 0; k < ray_total; ++k)
        elements[k] = hits[k].distance < kInfinity ? g.element(hits[k]) : kNoElement;
    for (uint32_t k = 0; k < ray_total; ++k) {
        if (elements[k] == kNoElement) continue;
        visitor.ray(origins[k].sample);
        visitor.texel(0, elements[k], vec3{1, 1, 1});
    }
    for (uint32_t k = 0; k < ray_total; ++k) {
        const auto& [sample, from] = origins[k];
        const accel::cpu::SurfaceHit& hit = hits[k];
        if (!(hit.distance < kInfinity)) {
            visitor.direct(sky_seen(g.world, from->at, rays[k].direction));
            continue;
        }
        visitor.direct(
            emission_seen(g.world, from->at, from->emitters, rays[k].direction, hit.at, hit.front));
        if (elements[k] != kNoElement) continue;
        visitor.ray(sample);
        follow_path(g, hit, g.samples.path(sample), visitor);
    }
}

}  // namespace aglow::transport::cpu
