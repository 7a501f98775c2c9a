// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights/emitters.h"

#include "aglow/accel/ray_scene.h"

#include <cmath>

namespace aglow::transport {
namespace {

/// Mean emission of a triangle over an even pattern of 3 x 3 points: its weight in the light tree,
/// where an error costs noise but no bias. Every emitting triangle keeps a positive weight.
float mean_emission(const Scene& scene, const Surfaces& surfaces, uint32_t triangle, vec3 factor) {
    float sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const float root = std::sqrt((static_cast<float>(i) + 0.5f) / 3);
            const float v = (static_cast<float>(k) + 0.5f) / 3;
            sum += luminance(
                emitted_luminance(scene, surfaces, {triangle, {root * (1 - v), root * v}}));
        }
    return shared::max(sum / 9, 0.02f * luminance(factor));
}

}  // namespace

Emitters::Emitters(const Scene& scene, const Surfaces& surfaces)
    : scene_(scene), surfaces_(surfaces), emitter_of_(surfaces.triangles.size(), kNotEmitting) {
    std::vector<TreeEmitter> tree_emitters;
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle) {
        const Material* m = material(triangle);
        if (!m || m->unlit || !(luminance(m->emission) > 0)) continue;
        const float size = area(surfaces, triangle);
        if (!(size > 0)) continue;
        TreeEmitter e;
        for (int i = 0; i < 3; ++i) e.bounds.add(surfaces.corner(triangle, i));
        e.normal = geometric_normal(surfaces, triangle);
        e.power = kPi * size * mean_emission(scene, surfaces, triangle, m->emission);
        e.two_sided = m->double_sided;
        emitter_of_[triangle] = static_cast<uint32_t>(emitters_.size());
        emitters_.push_back({triangle,
                             {surfaces.corner(triangle, 0), surfaces.corner(triangle, 1),
                              surfaces.corner(triangle, 2)},
                             e.normal,
                             coordinate_magnitude(surfaces, triangle),
                             m->emissive_texture.texture < 0 && !m->double_sided &&
                                 m->alpha_mode == AlphaMode::opaque,
                             m->emission});
        tree_emitters.push_back(e);
    }
    tree_ = LightTree(tree_emitters);
}

const Material* Emitters::material(uint32_t triangle) const {
    const int m = surfaces_.part(triangle).material;
    return m < 0 ? nullptr : &scene_.materials[static_cast<size_t>(m)];
}

vec3 Emitters::emitted(const SurfacePoint& at, bool front) const {
    if (emitter_of_[at.triangle] == kNotEmitting) return {0, 0, 0};
    if (!front && !material(at.triangle)->double_sided) return {0, 0, 0};
    return emitted_luminance(scene_, surfaces_, at);
}

EmittersSeen::EmittersSeen(const Emitters& all, vec3 p, vec3 n)
    : all_(all), p_(p), n_(n), few_(all.emitters_.size() <= kFew) {
    if (!few_) return;
    for (uint32_t i = 0; i < all_.emitters_.size(); ++i) {
        probability_[i] = all_.tree_.probability(i, p, n);
        if (probability_[i] > 0) sampler_[i] = sampler_of(i);
    }
}

TriangleSampler EmittersSeen::sampler_of(uint32_t emitter) const {
    const auto& [a, b, c] = all_.emitters_[emitter].corner;
    return {a - p_, b - p_, c - p_};
}

EmittersSeen::Choice EmittersSeen::choose(float u) const {
    if (!few_) {
        const auto choice = all_.tree_.draw(p_, n_, u);
        return {choice.emitter, choice.probability};
    }
    Choice last;
    for (uint32_t i = 0; i < all_.emitters_.size(); ++i) {
        if (!(probability_[i] > 0)) continue;
        last = {i, probability_[i]};
        if (u < probability_[i]) break;
        u -= probability_[i];
    }
    return last;
}

LightSample EmittersSeen::sample(vec3 u) const {
    const Choice choice = choose(u.x);
    if (!(choice.probability > 0)) return {};
    const Emitters::Emitter& light = all_.emitters_[choice.emitter];
    const TriangleSample point = few_ ? sampler_[choice.emitter]->sample({u.y, u.z})
                                      : sampler_of(choice.emitter).sample({u.y, u.z});
    if (!(point.pdf > 0)) return {};

    const auto& [a, b, c] = light.corner;
    const vec2 at = point.barycentrics;
    const vec3 to_light = a * (1 - at.x - at.y) + b * at.x + c * at.y - p_;
    const bool front = dot(light.normal, to_light) < 0;
    if (light.even && !front) return {};
    const SurfacePoint on_surface{light.triangle, at};
    const vec3 emission = light.even ? light.emission
                                     : all_.emitted(on_surface, front) *
                                           opacity(all_.scene_, all_.surfaces_, on_surface);
    if (!(luminance(emission) > 0)) return {};

    const float distance = length(to_light);
    if (!(distance > 0)) return {};
    // The shadow ray ends a clearance above the light, so that it meets neither it nor a twin of
    // it.
    const float height = shared::abs(dot(light.normal, to_light));
    const float cut = shared::min(1.0f, clearance(light.magnitude) / height);
    const float pdf = point.pdf * choice.probability;
    return {to_light / distance, distance * (1 - cut), emission / pdf, pdf};
}

float EmittersSeen::pdf(const SurfacePoint& at) const {
    const uint32_t emitter = all_.emitter_of_[at.triangle];
    if (emitter == Emitters::kNotEmitting) return 0;
    if (!few_)
        return all_.tree_.probability(emitter, p_, n_) * sampler_of(emitter).pdf(at.barycentrics);
    if (!sampler_[emitter]) return 0;
    return probability_[emitter] * sampler_[emitter]->pdf(at.barycentrics);
}

}  // namespace aglow::transport
