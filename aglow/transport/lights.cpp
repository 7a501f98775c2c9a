// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights.h"

#include "aglow/accel/ray_scene.h"
#include "aglow/transport/lights/light_tree.h"
#include "aglow/transport/lights/sky_distribution.h"
#include "aglow/transport/lights/triangle_sampling.h"

#include <cmath>

namespace aglow {
namespace {

struct Delta {
    LightKind kind;
    vec3 position;
    vec3 axis;  ///< unit, along which it shines
    vec3 intensity;
    float cone_scale = 0, cone_offset = 1;  ///< KHR_lights_punctual, inner and outer cone angles
};

Delta make_delta(const Light& light, const mat4& to_world) {
    Delta delta{light.kind, transform_point(to_world, {0, 0, 0}),
                normalize(transform_direction(to_world, {0, 0, -1})), light.intensity};
    if (light.kind == LightKind::spot) {
        const float cos_inner = std::cos(light.inner_cone), cos_outer = std::cos(light.outer_cone);
        delta.cone_scale = 1 / std::max(0.001f, cos_inner - cos_outer);
        delta.cone_offset = -cos_outer * delta.cone_scale;
    }
    return delta;
}

float cone_attenuation(const Delta& delta, vec3 from_light) {
    const float t = shared::clamp(
        dot(delta.axis, from_light) * delta.cone_scale + delta.cone_offset, 0.0f, 1.0f);
    return t * t;
}

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

/// An emissive triangle, with what sampling needs of it.
struct Emitter {
    uint32_t triangle;
    vec3 corner[3];
    vec3 normal;
    float magnitude;  ///< see coordinate_magnitude()
    bool even;        ///< emits `emission` all over, from its front only
    vec3 emission;
};

constexpr uint32_t kNotEmitting = 0xffffffffu;

}  // namespace

struct Lights::Data {
    const Scene& scene;
    const Surfaces& surfaces;
    std::vector<Delta> deltas = {};
    std::vector<Emitter> emitters = {};     // in order of the tree's
    std::vector<uint32_t> emitter_of = {};  // [triangle] the reverse, or kNotEmitting
    transport::LightTree tree = {};
    transport::SkyDistribution sky_image = {};

    const Material* material(uint32_t triangle) const {
        const int m = surfaces.part(triangle).material;
        return m < 0 ? nullptr : &scene.materials[static_cast<size_t>(m)];
    }
    void collect_deltas(const std::vector<mat4>& transforms);
    void collect_emitters();
};

void Lights::Data::collect_deltas(const std::vector<mat4>& transforms) {
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.in_scene || node.light < 0) continue;
        const Light& light = scene.lights[static_cast<size_t>(node.light)];
        if (luminance(light.intensity) > 0) deltas.push_back(make_delta(light, transforms[i]));
    }
}

void Lights::Data::collect_emitters() {
    std::vector<transport::TreeEmitter> tree_emitters;
    emitter_of.assign(surfaces.triangles.size(), kNotEmitting);
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle) {
        const Material* m = material(triangle);
        if (!m || m->unlit || !(luminance(m->emission) > 0)) continue;
        const float size = area(surfaces, triangle);
        if (!(size > 0)) continue;
        transport::TreeEmitter e;
        for (int i = 0; i < 3; ++i) e.bounds.add(surfaces.corner(triangle, i));
        e.normal = geometric_normal(surfaces, triangle);
        e.power = kPi * size * mean_emission(scene, surfaces, triangle, m->emission);
        e.two_sided = m->double_sided;
        emitter_of[triangle] = static_cast<uint32_t>(emitters.size());
        emitters.push_back({triangle,
                            {surfaces.corner(triangle, 0), surfaces.corner(triangle, 1),
                             surfaces.corner(triangle, 2)},
                            e.normal,
                            coordinate_magnitude(surfaces, triangle),
                            m->emissive_texture.texture < 0 && !m->double_sided &&
                                m->alpha_mode == AlphaMode::opaque,
                            m->emission});
        tree_emitters.push_back(e);
    }
    tree = transport::LightTree(tree_emitters);
}

Lights::Lights(const Scene& scene, const Surfaces& surfaces, const std::vector<mat4>& transforms)
    : data_(new Data{scene, surfaces}) {
    data_->collect_deltas(transforms);
    data_->collect_emitters();
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
    const float cone = delta.kind == LightKind::spot ? cone_attenuation(delta, -direction) : 1.0f;
    // Dividing twice keeps the square of a very small or large distance in range.
    return {direction, distance, delta.intensity * cone / distance / distance, 0};
}

bool Lights::has_emitters() const { return !data_->tree.empty(); }

LightSample Lights::emitter(vec3 p, vec3 n, vec3 u) const {
    const auto choice = data_->tree.draw(p, n, u.x);
    if (!(choice.probability > 0)) return {};
    const Emitter& light = data_->emitters[choice.emitter];
    const auto& [a, b, c] = light.corner;
    const auto sample = transport::sample_triangle(a - p, b - p, c - p, {u.y, u.z});
    if (!(sample.pdf > 0)) return {};

    const vec2 at = sample.barycentrics;
    const vec3 on_light = a * (1 - at.x - at.y) + b * at.x + c * at.y;
    const bool front = dot(light.normal, p - on_light) > 0;
    if (light.even && !front) return {};
    const SurfacePoint on_surface{light.triangle, at};
    const vec3 emission = light.even ? light.emission
                                     : emitted(on_surface, front) *
                                           opacity(data_->scene, data_->surfaces, on_surface);
    if (!(luminance(emission) > 0)) return {};

    const vec3 to_light = on_light - p;
    const float distance = length(to_light);
    if (!(distance > 0)) return {};
    // The shadow ray ends a clearance above the light, so that it meets neither it nor a twin of
    // it.
    const float height = shared::abs(dot(light.normal, to_light));
    const float cut = shared::min(1.0f, clearance(light.magnitude) / height);
    const float pdf = sample.pdf * choice.probability;
    return {to_light / distance, distance * (1 - cut), emission / pdf, pdf};
}

vec3 Lights::emitted(const SurfacePoint& at, bool front) const {
    const Material* m = data_->material(at.triangle);
    if (!m || m->unlit || (!front && !m->double_sided)) return {0, 0, 0};
    return emitted_luminance(data_->scene, data_->surfaces, at);
}

float Lights::emitter_pdf(vec3 p, vec3 n, const SurfacePoint& at) const {
    const uint32_t emitter = data_->emitter_of[at.triangle];
    if (emitter == kNotEmitting) return 0;
    const auto& [a, b, c] = data_->emitters[emitter].corner;
    return data_->tree.probability(emitter, p, n) *
           transport::triangle_pdf(a - p, b - p, c - p, at.barycentrics);
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
