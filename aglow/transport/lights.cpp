// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights.h"

#include "aglow/scene/photometry.h"
#include "aglow/transport/lights/emitters.h"
#include "aglow/transport/lights/sky_distribution.h"

#include <cmath>

namespace aglow {
namespace {

struct Delta {
    LightKind kind;
    vec3 position;
    vec3 axis;  ///< unit, along which it shines
    vec3 intensity;
    float cone_scale = 0, cone_offset = 1;  ///< KHR_lights_punctual, inner and outer cone angles
    const Photometry* photometry = nullptr;
    vec3 right = {1, 0, 0}, up = {0, 1, 0};  ///< unit, of the photometry's C0 and C90
};

Delta make_delta(const Light& light, const mat4& to_world) {
    Delta delta{light.kind, transform_point(to_world, {0, 0, 0}),
                normalize(transform_direction(to_world, {0, 0, -1})), light.intensity};
    if (light.kind == LightKind::spot) {
        const float cos_inner = std::cos(light.inner_cone), cos_outer = std::cos(light.outer_cone);
        delta.cone_scale = 1 / std::max(0.001f, cos_inner - cos_outer);
        delta.cone_offset = -cos_outer * delta.cone_scale;
    }
    if (light.kind == LightKind::photometric) {
        // The node's scale does not count, but a mirror turns C the other way round.
        delta.photometry = light.photometry.get();
        delta.right = normalize(transform_direction(to_world, {1, 0, 0}));
        delta.up = normalize(transform_direction(to_world, {0, 1, 0}));
    }
    return delta;
}

float cone_attenuation(const Delta& delta, vec3 from_light) {
    const float t = shared::clamp(
        dot(delta.axis, from_light) * delta.cone_scale + delta.cone_offset, 0.0f, 1.0f);
    return t * t;
}

/// What a light's own intensity is multiplied with along a direction away from it.
float distribution(const Delta& delta, vec3 from_light) {
    switch (delta.kind) {
        case LightKind::spot:
            return cone_attenuation(delta, from_light);
        case LightKind::photometric:
            return intensity(*delta.photometry,
                             {dot(from_light, delta.right), dot(from_light, delta.up),
                              -dot(from_light, delta.axis)});
        default:
            return 1;
    }
}

}  // namespace

struct Lights::Data {
    const Scene& scene;
    transport::Emitters emitters;
    std::vector<Delta> deltas = {};
    transport::SkyDistribution sky_image = {};

    void collect_deltas(const std::vector<mat4>& transforms);
};

void Lights::Data::collect_deltas(const std::vector<mat4>& transforms) {
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.in_scene || node.light < 0) continue;
        const Light& light = scene.lights[static_cast<size_t>(node.light)];
        if (luminance(light.intensity) > 0) deltas.push_back(make_delta(light, transforms[i]));
    }
}

Lights::Lights(const Scene& scene, const Surfaces& surfaces, const std::vector<mat4>& transforms)
    : data_(new Data{scene, transport::Emitters(scene, surfaces)}) {
    data_->collect_deltas(transforms);
    if (has_sky() && scene.sky->image)
        data_->sky_image = transport::SkyDistribution(*scene.sky->image);
}

Lights::Lights(Lights&&) noexcept = default;
Lights::~Lights() = default;

size_t Lights::delta_count() const { return data_->deltas.size(); }

LightSample Lights::delta(size_t i, vec3 p) const {
    const Delta& delta = data_->deltas[i];
    if (delta.kind == LightKind::directional) return {-delta.axis, kInfinity, delta.intensity, 0};
    const vec3 to_light = delta.position - p;
    const float distance = length(to_light);
    if (!(distance > 0)) return {};
    const vec3 direction = to_light / distance;
    const vec3 candela = delta.intensity * distribution(delta, -direction);
    // Dividing twice keeps the square of a very small or large distance in range.
    return {direction, distance, candela / distance / distance, 0};
}

bool Lights::has_emitters() const { return !data_->emitters.empty(); }

const transport::Emitters& Lights::emitters() const { return data_->emitters; }

vec3 Lights::emitted(const SurfacePoint& at, bool front) const {
    return data_->emitters.emitted(at, front);
}

bool Lights::has_sky() const {
    return data_->scene.sky && luminance(data_->scene.sky->luminance) > 0;
}

bool Lights::samples_sky() const {
    return has_sky() && data_->scene.sky->image && !data_->sky_image.black();
}

LightSample Lights::sky(vec2 u) const {
    const auto sample = data_->sky_image.draw(u);
    if (!(sample.pdf > 0)) return {};
    return {sample.direction, kInfinity, sky_luminance(sample.direction) / sample.pdf, sample.pdf};
}

vec3 Lights::sky_luminance(vec3 direction) const {
    if (!has_sky()) return {0, 0, 0};
    const Sky& sky = *data_->scene.sky;
    if (!sky.image) return sky.luminance;
    const Image& image = *sky.image;
    const vec2 uv = transport::equirectangular_uv(direction);
    const int x =
        std::min(static_cast<int>(uv.x * static_cast<float>(image.width)), image.width - 1);
    const int y =
        std::min(static_cast<int>(uv.y * static_cast<float>(image.height)), image.height - 1);
    return image.at(std::max(x, 0), std::max(y, 0)) * sky.luminance;
}

float Lights::sky_pdf(vec3 direction) const {
    return samples_sky() ? data_->sky_image.pdf(direction) : 0;
}

bool Lights::dark() const { return data_->deltas.empty() && !has_emitters() && !has_sky(); }

}  // namespace aglow
