// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights.h"

#include "aglow/scene/punctual_lights.h"
#include "aglow/transport/lights/emitters.h"
#include "aglow/transport/lights/sky_distribution.h"

#include <cmath>

namespace aglow {

struct Lights::Data {
    const Scene& scene;
    transport::Emitters emitters;
    std::vector<PlacedLight> deltas = {};
    transport::SkyDistribution sky_image = {};
};

Lights::Lights(const Scene& scene, const Surfaces& surfaces, const std::vector<mat4>& transforms)
    : data_(new Data{scene, transport::Emitters(scene, surfaces),
                     punctual_lights(scene, transforms)}) {
    if (has_sky() && scene.sky->image)
        data_->sky_image = transport::SkyDistribution(*scene.sky->image);
}

Lights::Lights(Lights&&) noexcept = default;
Lights::~Lights() = default;

size_t Lights::delta_count() const { return data_->deltas.size(); }

LightSample Lights::delta(size_t i, vec3 p) const {
    const shared::LightArrival light = arrival(data_->deltas[i], p);
    if (!(light.distance > 0)) return {};
    const bool sun = data_->deltas[i].light.kind == shared::kLightDirectional;
    return {light.direction, sun ? kInfinity : light.distance, light.normal_irradiance, 0};
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
