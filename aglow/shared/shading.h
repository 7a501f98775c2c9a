// SPDX-License-Identifier: Apache-2.0
// How a surface looks: glTF's metallic-roughness model, lit by an irradiance E, by what a mirror
// ray sees, and by lights without extent.
//
//   L = emitted + diffuse * E + mean * E_mean + mirror * L_mirror + sum over lights of
//       highlight * E_l
//
// where E_l is what a light gives a surface that it reaches, and E_mean is E without all E_l: light
// that comes from anywhere, for which rough metals and coats are as bright as its mean radiance
// E_mean / pi. Nothing is brighter than its surroundings: pi * (diffuse + mean) + mirror <= 1, so
// where E = pi L0 and no mirror ray sees more than L0, no surface that does not emit is brighter
// than L0.
//
// Source: Khronos, "glTF 2.0 specification", appendix B; Schlick, "An Inexpensive BRDF Model for
// Physically-based Rendering", 1994; Lagarde & de Rousiers, "Moving Frostbite to Physically Based
// Rendering", 2014 (Fresnel of rough surfaces).
#ifndef AGLOW_SHARED_SHADING_H
#define AGLOW_SHARED_SHADING_H
#include "aglow/shared/texture_lookup.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kMaterialUnlit = 1u;
AG_CONST uint kMaterialDoubleSided = 2u;  // emits from both sides
AG_CONST uint kMaterialMask = 4u;
AG_CONST uint kMaterialBlend = 8u;

// A material of glTF. 144 bytes.
struct SurfaceMaterial {
    vec4 base_color;
    vec3 emission;  // cd/m^2
    float metallic;
    float roughness;
    float alpha_cutoff;
    uint flags;  // kMaterial...
    uint unused;
    TextureUse base_color_texture;
    TextureUse metallic_roughness_texture;  // roughness in green, metallic in blue
    TextureUse emissive_texture;
};
AG_BUFFER_OF(SurfaceMaterial);

// What a material is at one point, textures and vertex colours included.
struct SurfaceColor {
    vec3 base_color;
    float metallic;   // 0 to 1
    float roughness;  // 0 to 1
    vec3 emitted;     // cd/m^2, towards the viewer
};

AG_CONST float kMostReflected = 0.98f;        // no real surface reflects more
AG_CONST float kUnlitLuminance = 100.0f;      // cd/m^2 of a white one under KHR_materials_unlit
AG_CONST float kLeastMirrored = 0.00390625f;  // of a mirror image: less is taken from E_mean

AG_CONST uint kHighlightGgx = 0u;
AG_CONST uint kHighlightPhong = 1u;

// What L is made of; see above.
struct SurfaceLook {
    vec3 diffuse;  // 1/sr
    vec3 mean;     // 1/sr
    vec3 mirror;
};

AG_FN vec3 bounded_color(vec3 color) {
    vec3 result;
    result.x = clamp(color.x, 0.0f, kMostReflected);
    result.y = clamp(color.y, 0.0f, kMostReflected);
    result.z = clamp(color.z, 0.0f, kMostReflected);
    return result;
}

// Reflectance at normal incidence of an index of refraction of 1.5.
AG_FN vec3 dielectric_reflectance() {
    vec3 result;
    result.x = 0.04f;
    result.y = 0.04f;
    result.z = 0.04f;
    return result;
}

// Reflectance at normal incidence; that of a metal is its base colour.
AG_FN vec3 normal_reflectance(SurfaceColor color) {
    return mix(dielectric_reflectance(), bounded_color(color.base_color), color.metallic);
}

// f0 + (f90 - f0) (1 - cosine)^5
AG_FN vec3 schlick(vec3 f0, vec3 f90, float cosine) {
    float x = clamp(1.0f - cosine, 0.0f, 1.0f);
    float x2 = x * x;
    return f0 + (f90 - f0) * (x2 * x2 * x);
}

// Share of light that a rough surface reflects at its coat or metal, seen under `cosine`. Facets
// that turn away from each other keep it from becoming a mirror at grazing angles.
AG_FN vec3 rough_fresnel(vec3 f0, float roughness, float cosine) {
    vec3 smooth_part;
    smooth_part.x = 1.0f - roughness;
    smooth_part.y = 1.0f - roughness;
    smooth_part.z = 1.0f - roughness;
    return schlick(f0, max(smooth_part, f0), cosine);
}

// Share of that light that comes as a mirror image: all up to a roughness of 0.3, where an image
// is blurred by 10 degrees; none from 0.5 on.
AG_FN float mirror_share(float roughness) {
    float t = clamp((0.5f - roughness) / 0.2f, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// The look without reflections: all of the base colour is diffuse, metals included.
AG_FN SurfaceLook matte_look(SurfaceColor color) {
    SurfaceLook look;
    look.diffuse = bounded_color(color.base_color) * 0.318309886f;
    look.mean = color.emitted * 0.0f;
    look.mirror = look.mean;
    return look;
}

// The look under `cosine` between normal and viewer. `weight` is the share of this surface's light
// that reaches the camera, `mirrors` is 0 where no further mirror ray may be traced. mirror is all
// 0 where no ray is worth it.
AG_FN SurfaceLook surface_look(SurfaceColor color, float cosine, vec3 weight, uint mirrors) {
    vec3 f = rough_fresnel(normal_reflectance(color), color.roughness, cosine);
    // What is not metal is a diffuse ground under a clear coat, whatever the share of metal.
    vec3 coat = rough_fresnel(dielectric_reflectance(), color.roughness, cosine);
    SurfaceLook look;
    look.diffuse = bounded_color(color.base_color) *
                   ((1.0f - color.metallic) * (1.0f - coat.x) * 0.318309886f);
    float share = mirrors != 0u ? mirror_share(color.roughness) : 0.0f;
    vec3 seen = weight * f * share;
    if (max(seen.x, max(seen.y, seen.z)) < kLeastMirrored) share = 0.0f;
    look.mirror = f * share;
    look.mean = f * ((1.0f - share) * 0.318309886f);
    return look;
}

// Width of the lobe of facets. Lights without extent stand for lamps of about a degree, so that
// even a perfect mirror shows them; and where the normal turns within the width of a ray's cone,
// the lobe is as wide as that makes it. Source: Tokuyoshi & Kaplanyan, "Improved Geometric Specular
// Antialiasing", I3D 2019.
AG_FN float lobe_alpha(float roughness, float curvature, float cone_width) {
    float alpha = max(roughness * roughness, 0.01f);
    float turn = curvature * cone_width;
    return sqrt(min(alpha * alpha + min(0.5f * turn * turn, 0.18f), 1.0f));
}

// Density of facets about the normal, 1/sr: Trowbridge & Reitz (GGX). Its integral over the
// hemisphere of facet normals h, weighted by n . h, is 1.
// Source: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007.
AG_FN float ggx_distribution(float alpha, float n_h) {
    float a2 = alpha * alpha;
    float d = n_h * n_h * (a2 - 1.0f) + 1.0f;
    return a2 / (3.14159265f * d * d);
}

// Smith's masking and shadowing over 4 (n . l) (n . v), correlated by height.
// Source: Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT
// 2014.
AG_FN float ggx_visibility(float alpha, float n_l, float n_v) {
    float a2 = alpha * alpha;
    float l = n_v * sqrt(n_l * n_l * (1.0f - a2) + a2);
    float v = n_l * sqrt(n_v * n_v * (1.0f - a2) + a2);
    return 0.5f / max(l + v, 1.0e-7f);
}

// Exponent of the Phong lobe about the mirror direction that is as wide as facets of `alpha` make
// it: 2 / alpha^2 - 2 about the facets' normal (Walter et al. 2007), a quarter of that about the
// mirror direction, which turns twice as fast (Fisher & Woo, "R.E versus N.H Specular Highlights",
// Graphics Gems IV, 1994).
AG_FN float phong_exponent(float alpha) { return max(0.5f / (alpha * alpha) - 0.5f, 0.0f); }

// base^exponent for 0 <= base <= 1. Large exponents by squaring: a device's pow() may be off by a
// hundredth there, because it multiplies the rounding of a logarithm by the exponent.
AG_FN float steep_power(float base, float exponent) {
    float whole = floor(exponent);
    float result = base > 0.0f ? pow(base, exponent - whole) : exponent > 0.0f ? 0.0f : 1.0f;
    float square = base;
    for (uint bits = uint(whole); bits != 0u; bits = bits >> 1u) {
        if ((bits & 1u) != 0u) result = result * square;
        square = square * square;
    }
    return result;
}

// 1/sr. Its integral over the hemisphere, weighted by n . l, is 1 at normal incidence.
// Source: Lafortune & Willems, "Using the Modified Phong Reflectance Model for Physically Based
// Rendering", 1994.
AG_FN float phong_lobe(float exponent, float r_l) {
    return (exponent + 2.0f) * 0.159154943f * steep_power(clamp(r_l, 0.0f, 1.0f), exponent);
}

AG_FN vec3 mirrored(vec3 direction, vec3 n) { return direction - n * (2.0f * dot(direction, n)); }

// BRDF of the highlight, 1/sr: `n` faces the viewer, `to_viewer` and `to_light` are unit.
AG_FN vec3 highlight(uint kind, vec3 f0, float alpha, vec3 n, vec3 to_viewer, vec3 to_light) {
    float n_l = dot(n, to_light);
    float n_v = max(dot(n, to_viewer), 1.0e-4f);
    vec3 one;
    one.x = 1.0f;
    one.y = 1.0f;
    one.z = 1.0f;
    if (!(n_l > 0.0f)) return one * 0.0f;
    if (kind == kHighlightPhong) {
        float lobe = phong_lobe(phong_exponent(alpha), dot(mirrored(-to_viewer, n), to_light));
        return schlick(f0, one, n_l) * lobe;
    }
    vec3 both = to_viewer + to_light;
    float size = length(both);
    if (!(size > 0.0f)) return one * 0.0f;
    vec3 h = both / size;
    float n_h = clamp(dot(n, h), 0.0f, 1.0f);
    return schlick(f0, one, dot(to_viewer, h)) *
           (ggx_distribution(alpha, n_h) * ggx_visibility(alpha, n_l, n_v));
}

// The mirror direction about the shading normal `n`, kept above the surface whose geometric normal
// `g` faces the viewer.
AG_FN vec3 mirror_direction(vec3 direction, vec3 n, vec3 g) {
    vec3 r = mirrored(direction, n);
    float above = dot(r, g);
    return above < 0.0f ? normalize(r - g * (2.0f * above)) : normalize(r);
}

// Where shadow rays start that leave `p` on a triangle whose vertex normals tell of a curved
// surface: on that surface, above the flat triangle, whose edges would otherwise show where light
// grazes. `p` itself where the normals tell of a flat or hollow one.
// Source: Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021, chapter 4.
AG_FN vec3 lifted_point(vec3 p, vec2 barycentrics, Triangle triangle, vec3 na, vec3 nb, vec3 nc) {
    float b = barycentrics.x;
    float c = barycentrics.y;
    float a = 1.0f - b - c;
    float da = min(dot(p - triangle.a, na), 0.0f);
    float db = min(dot(p - triangle.b, nb), 0.0f);
    float dc = min(dot(p - triangle.c, nc), 0.0f);
    return p - na * (a * da) - nb * (b * db) - nc * (c * dc);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::SurfaceMaterial) == 144);
#endif
#endif
