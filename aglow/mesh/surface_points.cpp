// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/texture.h"

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

/// Attribute of a vertex, interpolated to a point on its triangle.
template <class T>
T interpolate(const std::vector<T>& values, const Surfaces& surfaces, SurfacePoint at) {
    const uvec3 t = surfaces.triangles[at.triangle];
    const float b1 = at.barycentrics.x, b2 = at.barycentrics.y;
    return values[t.x] * (1 - b1 - b2) + values[t.y] * b1 + values[t.z] * b2;
}

const Material& material_of(const Scene& scene, const Surfaces& surfaces, uint32_t triangle) {
    // glTF's default material is fully metallic; for light, a surface without one is white.
    static const Material white = [] {
        Material m;
        m.metallic = 0;
        return m;
    }();
    const int index = surfaces.part(triangle).material;
    return index < 0 ? white : scene.materials[static_cast<size_t>(index)];
}

vec4 texel(const Scene& scene, const Surfaces& surfaces, SurfacePoint at,
           const TextureRef& reference, ColorCoding coding) {
    if (reference.texture < 0) return {1, 1, 1, 1};
    const auto set = static_cast<size_t>(reference.texcoord);
    const vec2 uv = set < surfaces.texcoords.size()
                        ? interpolate(surfaces.texcoords[set], surfaces, at)
                        : vec2{0, 0};
    return sample(scene, reference, uv, coding);
}

/// Base colour and alpha: factor * texture * vertex colour.
vec4 base(const Scene& scene, const Surfaces& surfaces, SurfacePoint at, const Material& material) {
    const vec4 t = texel(scene, surfaces, at, material.base_color_texture, ColorCoding::srgb);
    const vec4 c =
        surfaces.colors.empty() ? vec4{1, 1, 1, 1} : interpolate(surfaces.colors, surfaces, at);
    const vec4 f = material.base_color;
    return {f.x * t.x * c.x, f.y * t.y * c.y, f.z * t.z * c.z, f.w * t.w * c.w};
}

/// Twice the area as a vector along the normal. In double, where tiny triangles far from the
/// origin keep their normal.
struct Perpendicular {
    double x, y, z;
    double length() const { return std::sqrt(x * x + y * y + z * z); }
};

Perpendicular perpendicular(const Surfaces& surfaces, uint32_t triangle) {
    const vec3 p0 = surfaces.corner(triangle, 0), p1 = surfaces.corner(triangle, 1),
               p2 = surfaces.corner(triangle, 2);
    const double ax = double(p1.x) - double(p0.x), ay = double(p1.y) - double(p0.y),
                 az = double(p1.z) - double(p0.z);
    const double bx = double(p2.x) - double(p0.x), by = double(p2.y) - double(p0.y),
                 bz = double(p2.z) - double(p0.z);
    return {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
}

}  // namespace

vec3 base_color(const Scene& scene, const Surfaces& surfaces, SurfacePoint at) {
    const vec4 color = base(scene, surfaces, at, material_of(scene, surfaces, at.triangle));
    return {color.x, color.y, color.z};
}

vec3 diffuse_reflectance(const Scene& scene, const Surfaces& surfaces, SurfacePoint at) {
    const Material& material = material_of(scene, surfaces, at.triangle);
    const vec4 color = base(scene, surfaces, at, material);
    float metallic = 0;
    if (!material.unlit)
        metallic =
            material.metallic *
            texel(scene, surfaces, at, material.metallic_roughness_texture, ColorCoding::linear).z;
    const float share = 1 - std::clamp(metallic, 0.0f, 1.0f);
    const auto bounded = [&](float c) { return std::clamp(c * share, 0.0f, kMaxReflectance); };
    return {bounded(color.x), bounded(color.y), bounded(color.z)};
}

vec3 emitted_luminance(const Scene& scene, const Surfaces& surfaces, SurfacePoint at) {
    const Material& material = material_of(scene, surfaces, at.triangle);
    if (material.unlit || material.emission == vec3{0, 0, 0}) return {0, 0, 0};
    const vec4 t = texel(scene, surfaces, at, material.emissive_texture, ColorCoding::srgb);
    return material.emission * vec3{t.x, t.y, t.z};
}

float opacity(const Scene& scene, const Surfaces& surfaces, SurfacePoint at) {
    const Material& material = material_of(scene, surfaces, at.triangle);
    if (material.alpha_mode == AlphaMode::opaque) return 1;
    const float alpha = base(scene, surfaces, at, material).w;
    if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

vec3 position(const Surfaces& surfaces, SurfacePoint at) {
    return interpolate(surfaces.positions, surfaces, at);
}

vec3 geometric_normal(const Surfaces& surfaces, uint32_t triangle) {
    const Perpendicular n = perpendicular(surfaces, triangle);
    const double norm = n.length();
    if (!(norm > 0)) return {0, 0, 0};
    return {static_cast<float>(n.x / norm), static_cast<float>(n.y / norm),
            static_cast<float>(n.z / norm)};
}

vec3 shading_normal(const Surfaces& surfaces, SurfacePoint at) {
    const vec3 normal = interpolate(surfaces.normals, surfaces, at);
    const float norm = length(normal);
    return norm > 1e-6f ? normal / norm : geometric_normal(surfaces, at.triangle);
}

float area(const Surfaces& surfaces, uint32_t triangle) {
    return static_cast<float>(perpendicular(surfaces, triangle).length() / 2);
}

}  // namespace aglow
