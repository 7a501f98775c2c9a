// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/random.h"
#include "aglow/transport/irradiance.h"
#include "aglow/transport/lights/emitters.h"

namespace aglow::transport::cpu {

/// One estimate of a receiver's irradiance by one path, and what it took.
struct PathSample {
    Irradiance irradiance;
    int ray_count = 0;
    int bounces = 0;  ///< reflections followed
};

/// Estimates, without bias, what a receiver sees: direct light by sampling lights, reflected
/// light by following one path of cosine-distributed rays.
/// Thread safety  const members from any thread, each with its own random numbers.
class Tracer {
public:
    Tracer(const World& world, int bounces) : world_(world), bounces_(bounces) {}

    PathSample trace(const Receiver& receiver, Pcg32& random) const;

    /// Luminance along a camera ray, cd/m^2.
    vec3 luminance_along(const Ray& ray, Pcg32& random) const;

private:
    /// Where a path stands: `origin` is off the surface, on the side of both normals.
    struct Vertex {
        vec3 origin;
        vec3 normal;            ///< irradiance is measured on its plane
        vec3 geometric_normal;  ///< directions below its plane bring nothing
    };

    static Vertex vertex_of(const Receiver& receiver);
    /// The vertex on the side of a hit surface that the ray came from.
    Vertex vertex_at(const Hit& hit) const;
    /// Irradiance from lights that are found by sampling them; emitters and a sky with the weight
    /// that the balance heuristic leaves to that.
    vec3 sampled_light(const Vertex& vertex, const EmittersSeen& emitters, Pcg32& random,
                       int& ray_count) const;
    vec3 unless_blocked(const Vertex& vertex, const LightSample& light, int& ray_count) const;
    /// Irradiance that a cosine-distributed ray stands for which left the scene ...
    vec3 escaped_light(const Vertex& vertex, vec3 direction) const;
    /// ... or met an emissive surface.
    vec3 emitted_light(const Vertex& vertex, const EmittersSeen& emitters, vec3 direction,
                       const Hit& hit) const;

    const World& world_;
    int bounces_;
};

}  // namespace aglow::transport::cpu
