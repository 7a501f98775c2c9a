// SPDX-License-Identifier: Apache-2.0
// Three lamps with bulbs of known flux.
#include "aglow/scene/builtin/room.h"

#include <array>

namespace aglow::builtin {
namespace {

constexpr vec3 kWarmWhite{1.0f, 0.72f, 0.42f};  // chromaticity of about 2900 K, linear Rec. 709
constexpr float kBulbRadius = 0.05f;            // m

float surface_area(const Shape& shape) {
    float area = 0;
    for (const uvec3 t : shape.triangles) {
        const auto& p = shape.positions;
        area += 0.5f * length(cross(p[t.y] - p[t.x], p[t.z] - p[t.x]));
    }
    return area;
}

/// Luminance of a Lambertian surface that emits `flux` lumen in all: flux = pi * L * area. Taken
/// from the triangles, so that the flux is exact however coarse they are.
vec3 luminance_of(const Shape& shape, float flux) {
    return kWarmWhite * (flux / (kPi * surface_area(shape) * luminance(kWarmWhite)));
}

int emitter(SceneBuilder& scene, std::string name, const Shape& shape, float flux) {
    return scene.luminous(std::move(name), {0.7f, 0.7f, 0.7f}, luminance_of(shape, flux));
}

Shape bulb(vec3 center) { return sphere(center, kBulbRadius, 12, 8); }

/// Shade: an open cone, its outer cloth glowing from within, its inner side and rims plain.
struct Shade {
    Shape outer, inner;
};
Shade shade(vec3 base, float lower, float upper, float height) {
    constexpr int kSlices = 32;
    constexpr float kThickness = 0.003f;
    const std::array<vec2, 2> outside = {vec2{lower, 0}, {upper, height}};
    const std::array<vec2, 4> inside = {
        vec2{upper, height}, {upper - kThickness, height}, {lower - kThickness, 0}, {lower, 0}};
    return {lathe(outside, kSlices).moved(base), lathe(inside, kSlices).moved(base)};
}

void add_floor_lamp(SceneBuilder& scene, const room::Paints& paints, vec3 at) {
    constexpr float kShadeBase = 1.38f, kBulbHeight = 1.50f;
    const std::array<vec2, 11> stand = {vec2{0, 0},       {0.13f, 0},      {0.135f, 0.006f},
                                        {0.13f, 0.016f},  {0.03f, 0.024f}, {0.012f, 0.040f},
                                        {0.010f, 0.06f},  {0.010f, 1.40f}, {0.022f, 1.405f},
                                        {0.022f, 1.455f}, {0, 1.458f}};
    scene.add("floor lamp stand", lathe(stand, 28).moved(at), paints.brass);
    const Shade cone = shade(at + vec3{0, kShadeBase, 0}, 0.20f, 0.14f, 0.27f);
    const int cloth = emitter(scene, "floor lamp shade", cone.outer, 150);
    scene.add("floor lamp shade", {{cone.outer, cloth}, {cone.inner, paints.linen}});
    const Shape glass = bulb(at + vec3{0, kBulbHeight, 0});
    scene.add("floor lamp bulb", glass, emitter(scene, "floor lamp bulb", glass, 1200));
}

void add_table_lamp(SceneBuilder& scene, const room::Paints& paints, vec3 at) {
    const std::array<vec2, 14> body = {
        vec2{0, 0},      {0.065f, 0},     {0.07f, 0.008f}, {0.055f, 0.022f}, {0.075f, 0.06f},
        {0.09f, 0.11f},  {0.085f, 0.16f}, {0.06f, 0.20f},  {0.03f, 0.225f},  {0.014f, 0.24f},
        {0.012f, 0.27f}, {0.02f, 0.275f}, {0.02f, 0.315f}, {0, 0.318f}};
    scene.add("table lamp base", lathe(body, 32).moved(at), paints.ceramic);
    const Shade cone = shade(at + vec3{0, 0.27f, 0}, 0.155f, 0.11f, 0.20f);
    const int cloth = emitter(scene, "table lamp shade", cone.outer, 90);
    scene.add("table lamp shade", {{cone.outer, cloth}, {cone.inner, paints.linen}});
    const Shape glass = bulb(at + vec3{0, 0.362f, 0});
    scene.add("table lamp bulb", glass, emitter(scene, "table lamp bulb", glass, 800));
}

void add_pendant(SceneBuilder& scene, const room::Paints& paints, vec3 ceiling) {
    constexpr float kDrop = 0.52f, kRadius = 0.14f;
    const vec3 globe_center = ceiling - vec3{0, kDrop + kRadius, 0};
    const std::array<vec2, 5> rose = {
        vec2{0, -0.025f}, {0.05f, -0.022f}, {0.06f, -0.006f}, {0.06f, 0.004f}, {0, 0.004f}};
    Shape fitting = lathe(rose, 24).moved(ceiling);
    fitting.append(cylinder(ceiling - vec3{0, kDrop - 0.02f, 0}, 0.004f, kDrop, 10));
    fitting.append(cylinder(ceiling - vec3{0, kDrop + 0.012f, 0}, 0.035f, 0.05f, 24));
    scene.add("pendant fitting", fitting, paints.black);
    const Shape globe = sphere(globe_center, kRadius, 16, 7);
    scene.add("pendant globe", globe, emitter(scene, "pendant globe", globe, 1500));
}

}  // namespace

void add_lamps(SceneBuilder& scene, const room::Paints& paints) {
    add_floor_lamp(scene, paints, {2.16f, 0, -0.77f});
    add_table_lamp(scene, paints, {-1.85f, 0.682f, room::kHalfZ - 0.36f});
    add_pendant(scene, paints, {0.78f, room::kHeight, 0.42f});
}

}  // namespace aglow::builtin
