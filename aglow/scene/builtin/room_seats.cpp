// SPDX-License-Identifier: Apache-2.0
// Sofa, armchair and what lies on them. Each is made facing +Z about its own origin, then turned.
#include "aglow/scene/builtin/room.h"

#include <array>

namespace aglow::builtin {
namespace {

constexpr int kCushionSegments = 3;

Shape cushion(vec3 lo, vec3 hi, float radius, float bulge) {
    return rounded_box(lo, hi, radius, kCushionSegments, bulge);
}

Shape tapered_leg(vec3 top, float height) {
    const std::array<vec2, 4> profile = {
        vec2{0, -height}, {0.013f, -height}, {0.022f, 0.01f}, {0, 0.01f}};
    return lathe(profile, 16).moved(top);
}

Shape four_legs(float half_x, float half_z, float top, float height) {
    Shape legs;
    for (const float x : {-half_x, half_x})
        for (const float z : {-half_z, half_z}) legs.append(tapered_leg({x, top, z}, height));
    return legs;
}

/// Square pillow that is thick in the middle, standing on its lower edge and leaning back.
Shape pillow(float size, float thickness, float lean_degrees) {
    const float h = size / 2;
    return rounded_box({-h, -h, -0.028f}, {h, h, 0.028f}, 0.026f, 2, thickness / 2 - 0.028f)
        .turned({1, 0, 0}, -lean_degrees)
        .moved({0, h, 0});
}

struct Seat {
    Shape body, cushions, legs;
};

/// A seat for `places` people: body with arms, one seat and one back cushion for each.
Seat seat(int places, float place_width, float depth) {
    constexpr float kArm = 0.17f, kFloorGap = 0.13f, kSeatTop = 0.44f, kArmTop = 0.60f;
    constexpr float kBack = 0.20f, kBackTop = 0.78f;
    const float inner = place_width * static_cast<float>(places) / 2, outer = inner + kArm;
    const float rear = -depth / 2, front = depth / 2;
    Seat s;
    s.body = rounded_box({-outer + 0.02f, kFloorGap, rear + 0.02f},
                         {outer - 0.02f, 0.30f, front - 0.03f}, 0.03f, kCushionSegments);
    s.body.append(rounded_box({-inner - 0.02f, 0.2f, rear}, {inner + 0.02f, kBackTop, rear + kBack},
                              0.07f, kCushionSegments));
    for (const float side : {-1.0f, 1.0f}) {
        const float x = side * (inner + kArm / 2);
        s.body.append(rounded_box({x - kArm / 2, kFloorGap, rear - 0.005f},
                                  {x + kArm / 2, kArmTop, front - 0.01f}, 0.06f, kCushionSegments));
    }
    for (int i = 0; i < places; ++i) {
        const float x0 = -inner + place_width * static_cast<float>(i), x1 = x0 + place_width;
        s.cushions.append(cushion({x0 + 0.004f, kSeatTop - 0.17f, rear + kBack - 0.04f},
                                  {x1 - 0.004f, kSeatTop, front + 0.01f}, 0.05f, 0.022f));
        s.cushions.append(
            cushion({x0 + 0.015f, 0, -0.09f}, {x1 - 0.015f, 0.42f, 0.09f}, 0.07f, 0.03f)
                .turned({1, 0, 0}, -14)
                .moved({0, kSeatTop - 0.01f, rear + kBack + 0.10f}));
    }
    s.legs = four_legs(outer - 0.10f, depth / 2 - 0.10f, kFloorGap, kFloorGap);
    return s;
}

Shape placed(const Shape& shape, float degrees, vec3 at) {
    return shape.turned({0, 1, 0}, degrees).moved(at);
}

}  // namespace

void add_seats(SceneBuilder& scene, const room::Paints& paints) {
    const int fabric = scene.diffuse("sofa fabric", {0.50f, 0.45f, 0.39f});
    const int teal = scene.diffuse("armchair fabric", {0.055f, 0.19f, 0.21f});
    const int terracotta = scene.diffuse("terracotta cloth", {0.56f, 0.17f, 0.075f});
    const int mustard = scene.diffuse("mustard cloth", {0.62f, 0.37f, 0.06f});

    constexpr float kFacesWest = -90;
    const vec3 sofa_place{2.0f, 0, 0.45f};
    const Seat sofa = seat(2, 0.80f, 0.88f);
    const auto on_sofa = [&](const Shape& shape) { return placed(shape, kFacesWest, sofa_place); };
    scene.add("sofa", {{on_sofa(sofa.body), fabric},
                       {on_sofa(sofa.cushions), fabric},
                       {on_sofa(sofa.legs), paints.dark_wood}});
    scene.add(
        "terracotta pillow",
        on_sofa(pillow(0.42f, 0.15f, 24).turned({0, 1, 0}, 12).moved({-0.58f, 0.455f, 0.06f})),
        terracotta);
    scene.add(
        "mustard pillow",
        on_sofa(pillow(0.38f, 0.14f, 28).turned({0, 1, 0}, -16).moved({0.56f, 0.455f, 0.08f})),
        mustard);

    constexpr float kFacesNorthEast = 140;
    const vec3 chair_place{-0.45f, 0, 1.05f};
    const Seat chair = seat(1, 0.58f, 0.80f);
    const auto on_chair = [&](const Shape& shape) {
        return placed(shape, kFacesNorthEast, chair_place);
    };
    scene.add("armchair", {{on_chair(chair.body), teal},
                           {on_chair(chair.cushions), teal},
                           {on_chair(chair.legs), paints.dark_wood}});
    scene.add("linen pillow",
              on_chair(pillow(0.36f, 0.13f, 26).turned({0, 1, 0}, 8).moved({0.04f, 0.455f, 0.07f})),
              paints.linen);
}

}  // namespace aglow::builtin
