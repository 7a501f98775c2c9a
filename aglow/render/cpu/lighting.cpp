// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/cpu/lighting.h"

#include "aglow/encode/lightmap.h"
#include "aglow/shared/sky.h"

#include <algorithm>

namespace aglow::render::cpu {
namespace {

/// Index that `u` picks of cumulative shares, and its own share.
struct Pick {
    size_t index;
    float share;
    float within;  ///< where u lies within that share, 0 to 1
};

Pick pick(const float* cumulative, size_t count, float u) {
    const float* found = std::upper_bound(cumulative, cumulative + count - 1, u);
    const auto index = static_cast<size_t>(found - cumulative);
    const float before = index == 0 ? 0 : cumulative[index - 1];
    const float share = cumulative[index] - before;
    return {index, share, share > 0 ? std::clamp((u - before) / share, 0.0f, 1.0f) : 0.5f};
}

/// One side of a surface, and what looks for light from there.
struct Side {
    const World& world;
    const Surface& surface;
    float side;
    uint64_t& ray_count;

    vec3 normal() const { return surface.normal * side; }
    vec3 geometric_normal() const { return surface.geometric_normal * side; }
    vec3 origin() const {
        return offset_origin(surface.position, geometric_normal(), surface.magnitude);
    }
    float visibility(vec3 from, vec3 direction, float far) const {
        ++ray_count;
        return world.rays.visibility({from, direction, far});
    }

    /// One-sample estimate of what emissive triangles give, lux.
    vec3 from_emitters(Draw draw) const {
        const EmitterTable& table = world.tables.emitters;
        if (table.triangles.empty()) return {0, 0, 0};
        const vec3 u = shared::owen_sobol_3d(
            draw.sample,
            shared::draw_seed(world.tables.seed, draw.pixel, draw.depth, shared::kDrawEmitter));
        const Pick picked = pick(table.cumulative.data(), table.cumulative.size(), u.x);
        const uint32_t triangle = table.triangles[picked.index];
        const Surfaces& s = world.surfaces;
        const shared::EmitterSample light = shared::sample_emitter(
            {s.corner(triangle, 0), s.corner(triangle, 1), s.corner(triangle, 2)}, picked.share,
            {u.y, u.z}, origin(), normal());
        if (!(light.weight > 0) || !(dot(light.direction, geometric_normal()) > 0))
            return {0, 0, 0};
        const int index = s.part(triangle).material;
        if (!light.front && !world.scene.materials[static_cast<size_t>(index)].double_sided)
            return {0, 0, 0};
        const SurfacePoint at{triangle, light.barycentrics};
        const vec3 emitted = emitted_luminance(world.scene, s, at) * opacity(world.scene, s, at);
        if (emitted == vec3{0, 0, 0}) return {0, 0, 0};
        // The ray ends a clearance above the light, so that it meets neither it nor a twin of it.
        const float leaving = std::abs(dot(aglow::geometric_normal(s, triangle), light.direction));
        const float cut =
            clearance(coordinate_magnitude(s, triangle)) / shared::max(leaving, 1e-6f);
        const float far = shared::max(light.distance - cut, 0.0f);
        return emitted * (light.weight * visibility(origin(), light.direction, far));
    }

    /// One-sample estimate of what the sky gives, lux.
    vec3 from_sky(Draw draw) const {
        const std::optional<Sky>& sky = world.scene.sky;
        if (!sky || !(luminance(sky->luminance) > 0)) return {0, 0, 0};
        const vec2 u = shared::owen_sobol_2d(
            draw.sample,
            shared::draw_seed(world.tables.seed, draw.pixel, draw.depth, shared::kDrawSky));
        if (sky->image) return from_sky_image(u);
        const vec3 direction = shared::around_normal(shared::cosine_hemisphere(u), normal());
        if (!(dot(direction, geometric_normal()) > 0)) return {0, 0, 0};
        return sky->luminance * (kPi * visibility(origin(), direction, kInfinity));
    }

    vec3 from_sky_image(vec2 u) const {
        const SkyTable& table = world.tables.sky;
        if (table.width == 0) return {0, 0, 0};
        const auto width = static_cast<size_t>(table.width);
        const Pick row = pick(table.rows.data(), table.rows.size(), u.y);
        const Pick cell = pick(&table.cells[row.index * width], width, u.x);
        const vec2 uv{
            (static_cast<float>(cell.index) + cell.within) / static_cast<float>(width),
            (static_cast<float>(row.index) + row.within) / static_cast<float>(table.height)};
        const vec3 direction = shared::sky_direction(uv);
        const float cosine = dot(direction, normal());
        if (!(cosine > 0) || !(dot(direction, geometric_normal()) > 0)) return {0, 0, 0};
        const float weight =
            shared::sky_weight(table.width, table.height, row.share * cell.share, uv);
        const vec3 pixel = world.scene.sky->image->pixels[row.index * width + cell.index];
        return pixel * world.scene.sky->luminance *
               (weight * cosine * visibility(origin(), direction, kInfinity));
    }
};

}  // namespace

Incoming incoming_light(const World& world, const Surface& surface, const Gloss& gloss, Draw draw,
                        uint64_t& ray_count) {
    const float lit_side = world.baked() ? 1.0f : surface.side();
    const Side side{world, surface, lit_side, ray_count};
    Incoming light;
    if (world.baked())
        light.irradiance = baked_irradiance(world.surfaces, *world.stored.irradiance, surface.at);
    else
        light.irradiance = side.from_sky(draw) + side.from_emitters(draw);

    const bool stored = world.baked() && world.stored.has_punctual;
    vec3 punctual{0, 0, 0};
    if (!stored || gloss.wanted) {
        for (const PlacedLight& placed : world.lights) {
            const shared::LightArrival from = arrival(placed, surface.position);
            const float n_l = dot(surface.normal, from.direction);
            const float from_side = n_l > 0 ? 1.0f : -1.0f;
            const bool shines = gloss.wanted && from_side == surface.side();
            if ((from_side != lit_side && !shines) || from.normal_irradiance == vec3{0, 0, 0})
                continue;
            const float seen =
                side.visibility(surface.shadow_origin(from_side), from.direction, from.distance);
            const vec3 given = from.normal_irradiance * (std::abs(n_l) * seen);
            if (from_side == lit_side) punctual += given;
            if (shines)
                light.highlight += given * shared::highlight(gloss.kind, gloss.f0, gloss.alpha,
                                                             surface.normal * from_side,
                                                             gloss.to_viewer, from.direction);
        }
    }
    if (stored) {
        light.mean = shared::max(light.irradiance - punctual, vec3{0, 0, 0});
    } else {
        light.mean = light.irradiance;
        light.irradiance += punctual;
    }
    return light;
}

vec3 sky_luminance(const Scene& scene, vec3 direction) {
    if (!scene.sky) return {0, 0, 0};
    if (!scene.sky->image) return scene.sky->luminance;
    const Image& image = *scene.sky->image;
    const shared::TexelQuad q = shared::sky_quad(image.width, image.height, direction);
    const vec3 upper =
        shared::mix(image.pixels[q.upper_left], image.pixels[q.upper_right], q.right);
    const vec3 lower =
        shared::mix(image.pixels[q.lower_left], image.pixels[q.lower_right], q.right);
    return scene.sky->luminance * shared::mix(upper, lower, q.down);
}

vec3 baked_irradiance(const Surfaces& surfaces, const Image& irradiance, SurfacePoint at) {
    const uvec3 t = surfaces.triangles[at.triangle];
    const float b1 = at.barycentrics.x, b2 = at.barycentrics.y;
    const std::vector<vec2>& uvs = surfaces.lightmap_uvs;
    return sample_lightmap(irradiance, uvs[t.x] * (1 - b1 - b2) + uvs[t.y] * b1 + uvs[t.z] * b2);
}

}  // namespace aglow::render::cpu
