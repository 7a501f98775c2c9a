// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/path/cpu/tracer.h"

#include <algorithm>
#include <cmath>

namespace aglow::transport::cpu {
namespace {

constexpr int kSureBounces = 3;         // reflections before Russian roulette may end a path
constexpr float kMostSurvival = 0.95f;  // bounds the length of paths between perfect reflectors
/// Share of a shadow ray left out at its end, so that it does not meet the surface that a light
/// stands on: some 80 units in the last place of the distance.
constexpr float kShadowSlack = 1e-5f;

vec2 uniform2(Pcg32& random) {
    const float x = random.uniform();
    return {x, random.uniform()};
}

vec3 uniform3(Pcg32& random) {
    const vec2 u = uniform2(random);
    return {u.x, u.y, random.uniform()};
}

/// A direction about unit `n` with density cos / pi.
vec3 cosine_direction(vec3 n, vec2 u) {
    const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
    const vec3 local = {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u.x)};
    return Frame(n).to_world(local);
}

float cosine_pdf(vec3 n, vec3 direction) { return std::max(0.0f, dot(n, direction)) / kPi; }

float largest(vec3 c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

Tracer::Vertex Tracer::vertex_of(const Receiver& receiver) {
    return {offset_origin(receiver.position, receiver.geometric_normal, receiver.magnitude),
            receiver.normal, receiver.geometric_normal};
}

Tracer::Vertex Tracer::vertex_at(const Hit& hit) const {
    const vec3 front = geometric_normal(world_.surfaces, hit.at.triangle);
    const vec3 n = hit.front ? front : -front;
    const float magnitude = coordinate_magnitude(world_.surfaces, hit.at.triangle);
    return {offset_origin(position(world_.surfaces, hit.at), n, magnitude), n, n};
}

vec3 Tracer::unless_blocked(const Vertex& vertex, const LightSample& light, int& ray_count) const {
    const float cosine = dot(vertex.normal, light.direction);
    if (!(cosine > 0) || !(dot(vertex.geometric_normal, light.direction) > 0)) return {0, 0, 0};
    if (!(largest(light.normal_irradiance) > 0)) return {0, 0, 0};
    ++ray_count;
    const Ray shadow{vertex.origin, light.direction, light.distance * (1 - kShadowSlack)};
    return light.normal_irradiance * (cosine * world_.rays.visibility(shadow));
}

vec3 Tracer::sampled_light(const Vertex& vertex, const EmittersSeen& emitters, Pcg32& random,
                           int& ray_count) const {
    const Lights& lights = world_.lights;
    vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < lights.delta_count(); ++i)
        sum += unless_blocked(vertex, lights.delta(i, vertex.origin), ray_count);
    const auto add = [&](const LightSample& light) {
        if (!(light.pdf > 0)) return;
        const float weight = light.pdf / (light.pdf + cosine_pdf(vertex.normal, light.direction));
        sum += unless_blocked(vertex, light, ray_count) * weight;
    };
    if (lights.has_emitters()) add(emitters.sample(uniform3(random)));
    if (lights.samples_sky()) add(lights.sky(uniform2(random)));
    return sum;
}

vec3 Tracer::escaped_light(const Vertex& vertex, vec3 direction) const {
    const Lights& lights = world_.lights;
    if (!lights.has_sky()) return {0, 0, 0};
    const float ray_pdf = cosine_pdf(vertex.normal, direction);
    const float sky_pdf = lights.samples_sky() ? lights.sky_pdf(direction) : 0;
    const float weight = sky_pdf > 0 ? ray_pdf / (ray_pdf + sky_pdf) : 1;
    return lights.sky_luminance(direction) * (kPi * weight);
}

vec3 Tracer::emitted_light(const Vertex& vertex, const EmittersSeen& emitters, vec3 direction,
                           const Hit& hit) const {
    const vec3 emitted = world_.lights.emitted(hit.at, hit.front);
    if (!(largest(emitted) > 0)) return {0, 0, 0};
    const float ray_pdf = cosine_pdf(vertex.normal, direction);
    return emitted * (kPi * ray_pdf / (ray_pdf + emitters.pdf(hit.at)));
}

PathSample Tracer::trace(const Receiver& receiver, Pcg32& random) const {
    PathSample result;
    Vertex vertex = vertex_of(receiver);
    vec3 throughput = {1, 1, 1};  // of irradiance here to irradiance at the receiver
    for (int bounce = 0;; ++bounce) {
        vec3& sum = bounce == 0 ? result.irradiance.direct : result.irradiance.indirect;
        const EmittersSeen emitters(world_.lights.emitters(), vertex.origin, vertex.normal);
        sum += throughput * sampled_light(vertex, emitters, random, result.ray_count);
        result.bounces = bounce;

        const bool last = bounce == bounces_;
        if (last && !world_.lights.has_sky() && !world_.lights.has_emitters()) break;
        const vec3 direction = cosine_direction(vertex.normal, uniform2(random));
        if (!(dot(vertex.geometric_normal, direction) > 0)) break;
        ++result.ray_count;
        const std::optional<Hit> hit = world_.rays.intersect({vertex.origin, direction});
        if (!hit) {
            sum += throughput * escaped_light(vertex, direction);
            break;
        }
        sum += throughput * emitted_light(vertex, emitters, direction, *hit);
        if (last) break;

        // What the ray sees is rho / pi * E there, and the ray stands for pi times it.
        throughput *= diffuse_reflectance(world_.scene, world_.surfaces, hit->at);
        if (!(largest(throughput) > 0)) break;
        if (bounces_ == kConverged && bounce >= kSureBounces) {
            const float survival = std::min(kMostSurvival, largest(throughput));
            if (random.uniform() >= survival) break;
            throughput *= 1 / survival;
        }
        vertex = vertex_at(*hit);
    }
    return result;
}

vec3 Tracer::luminance_along(const Ray& ray, Pcg32& random) const {
    const std::optional<Hit> hit = world_.rays.intersect(ray);
    if (!hit) return world_.lights.sky_luminance(ray.direction);
    Receiver receiver = receiver_at(world_.surfaces, hit->at);
    if (!hit->front) {
        receiver.normal = -receiver.normal;
        receiver.geometric_normal = -receiver.geometric_normal;
    }
    const vec3 reflectance = diffuse_reflectance(world_.scene, world_.surfaces, hit->at);
    const vec3 emitted = world_.lights.emitted(hit->at, hit->front);
    if (!(largest(reflectance) > 0)) return emitted;
    return emitted + reflectance * trace(receiver, random).irradiance.total() * (1 / kPi);
}

}  // namespace aglow::transport::cpu
