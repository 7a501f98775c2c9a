// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/cpu/surface.h"

#include "aglow/core/image.h"

#include <algorithm>
#include <cmath>

namespace aglow::render::cpu {
namespace {

std::array<float, 256> byte_values(bool srgb) {
    std::array<float, 256> values{};
    for (size_t i = 0; i < values.size(); ++i) {
        const float value = static_cast<float>(i) / 255;
        values[i] = srgb ? srgb_to_linear(value) : value;
    }
    return values;
}

const std::array<float, 256> kLinear = byte_values(false);
const std::array<float, 256> kFromSrgb = byte_values(true);

vec4 sample_level(const MaterialTable& table, const shared::TextureLevels& texture, vec2 st,
                  uint32_t level, uint32_t blend) {
    const auto& color = texture.srgb ? kFromSrgb : kLinear;
    const auto texel = [&](uint32_t index) -> vec4 {
        const uint32_t rgba = table.texels[index];
        return {color[rgba & 255u], color[rgba >> 8 & 255u], color[rgba >> 16 & 255u],
                kLinear[rgba >> 24]};
    };
    const shared::TexelQuad quad = shared::texel_quad(texture, st, level, blend);
    return shared::blend_quad(quad, texel(quad.upper_left), texel(quad.upper_right),
                              texel(quad.lower_left), texel(quad.lower_right));
}

template <class T>
T interpolate(const std::vector<T>& values, uvec3 corners, vec2 b) {
    return values[corners.x] * (1 - b.x - b.y) + values[corners.y] * b.x + values[corners.z] * b.y;
}

/// Reads a material's textures at one point, each at its own mip level.
struct Reader {
    const Surfaces& surfaces;
    const MaterialTable& table;
    SurfacePoint at;
    float triangle_area, width, cosine;

    vec4 operator()(const shared::TextureUse& use) const {
        if (use.texture == shared::kNoTexture) return {1, 1, 1, 1};
        const shared::TextureLevels& texture = table.textures[use.texture];
        if (use.texcoord >= surfaces.texcoords.size())
            return sample_texture(table, use.texture, shared::texture_coordinates(use, {0, 0}), 0);
        const std::vector<vec2>& uvs = surfaces.texcoords[use.texcoord];
        const uvec3 t = surfaces.triangles[at.triangle];
        const float level = shared::texture_level(
            texture, shared::texture_coordinates(use, uvs[t.x]),
            shared::texture_coordinates(use, uvs[t.y]), shared::texture_coordinates(use, uvs[t.z]),
            triangle_area, width, cosine);
        const vec2 st = shared::texture_coordinates(use, interpolate(uvs, t, at.barycentrics));
        return sample_texture(table, use.texture, st, level);
    }
};

shared::SurfaceColor color_at(const Surfaces& surfaces, const shared::SurfaceMaterial& material,
                              const Reader& read, bool emits) {
    const vec4 f = material.base_color, t = read(material.base_color_texture);
    const vec4 c = surfaces.colors.empty()
                       ? vec4{1, 1, 1, 1}
                       : interpolate(surfaces.colors, surfaces.triangles[read.at.triangle],
                                     read.at.barycentrics);
    const vec4 mr = read(material.metallic_roughness_texture);
    shared::SurfaceColor color;
    color.base_color = {f.x * t.x * c.x, f.y * t.y * c.y, f.z * t.z * c.z};
    color.metallic = std::clamp(material.metallic * mr.z, 0.0f, 1.0f);
    color.roughness = std::clamp(material.roughness * mr.y, 0.0f, 1.0f);
    color.emitted = {0, 0, 0};
    if (emits && material.emission != vec3{0, 0, 0}) {
        const vec4 e = read(material.emissive_texture);
        color.emitted = material.emission * vec3{e.x, e.y, e.z};
    }
    return color;
}

}  // namespace

vec4 sample_texture(const MaterialTable& table, uint32_t texture, vec2 st, float level) {
    const shared::TextureLevels& levels = table.textures[texture];
    if (!(level > 0)) return sample_level(table, levels, st, 0, levels.nearest ? 0u : 1u);
    const auto finer = static_cast<uint32_t>(level);
    const float share = level - static_cast<float>(finer);
    const vec4 fine = sample_level(table, levels, st, finer, 1);
    if (!(share > 0)) return fine;
    return shared::mix(fine, sample_level(table, levels, st, finer + 1, 1), share);
}

vec3 Surface::shadow_origin(float side) const {
    const vec3 lifted = shared::lifted_point(position, at.barycentrics, corners, normals[0] * side,
                                             normals[1] * side, normals[2] * side);
    return offset_origin(lifted, geometric_normal * side, magnitude);
}

Surface surface_at(const Surfaces& surfaces, const MaterialTable& table, const Hit& hit,
                   vec3 direction, const shared::RayCone& cone) {
    const uvec3 t = surfaces.triangles[hit.at.triangle];
    const shared::SurfaceMaterial& material =
        table.materials[material_index(table, surfaces.part(hit.at.triangle))];
    Surface s;
    s.at = hit.at;
    s.front = hit.front;
    s.flags = material.flags;
    s.position = position(surfaces, hit.at);
    s.geometric_normal = geometric_normal(surfaces, hit.at.triangle);
    s.normal = shading_normal(surfaces, hit.at);
    s.corners = {surfaces.positions[t.x], surfaces.positions[t.y], surfaces.positions[t.z]};
    s.normals = {surfaces.normals[t.x], surfaces.normals[t.y], surfaces.normals[t.z]};
    s.magnitude = coordinate_magnitude(surfaces, hit.at.triangle);
    s.curvature =
        s.side() * shared::triangle_curvature(s.corners, s.normals[0], s.normals[1], s.normals[2]);
    const Reader read{surfaces,   table,
                      hit.at,     area(surfaces, hit.at.triangle),
                      cone.width, dot(s.geometric_normal, direction)};
    const bool emits = s.front || (material.flags & shared::kMaterialDoubleSided);
    s.color = color_at(surfaces, material, read, emits);
    return s;
}

}  // namespace aglow::render::cpu
