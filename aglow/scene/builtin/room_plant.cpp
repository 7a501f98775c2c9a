// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/room.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr int kStemCount = 26;
constexpr float kSoilHeight = 0.27f;  // m

Shape pot() {
    const std::array<vec2, 11> profile = {vec2{0, 0},
                                          {0.115f, 0},
                                          {0.122f, 0.006f},
                                          {0.150f, 0.25f},
                                          {0.162f, 0.25f},
                                          {0.166f, 0.29f},
                                          {0.160f, 0.292f},
                                          {0.148f, 0.29f},
                                          {0.145f, 0.262f},
                                          {0.143f, kSoilHeight - 0.005f},
                                          {0, kSoilHeight - 0.005f}};
    return lathe(profile, 40);
}

Shape soil() {
    const auto point = [](float u, float v) {
        const float angle = 2 * kPi * u, radius = 0.146f * (1 - v);
        const float bump = 0.006f * std::sin(3 * angle + 9 * v) * v * (1 - v) * 4;
        return vec3{radius * std::cos(angle), kSoilHeight + bump, -radius * std::sin(angle)};
    };
    return sheet(point, 32, 5);
}

/// One stem that bends outward under its leaf: where it goes at height fraction t.
struct Stem {
    float angle, reach, height;

    vec3 at(float t) const {
        const float out = reach * t * t, up = kSoilHeight + height * (t - 0.18f * t * t);
        return {0.03f * std::cos(angle) + out * std::cos(angle), up,
                -0.03f * std::sin(angle) - out * std::sin(angle)};
    }
    vec3 tip_direction() const { return normalize(at(1) - at(0.9f)); }
};

Shape stem_tube(const Stem& stem) {
    std::array<vec3, 7> path{};
    std::array<float, 7> radii{};
    for (size_t i = 0; i < path.size(); ++i) {
        const float t = static_cast<float>(i) / 6;
        path[i] = stem.at(t);
        radii[i] = 0.0055f - 0.003f * t;
    }
    return tube(path, radii, 6);
}

/// Leaf blade that grows from a stem's tip and droops, slightly folded along its midrib.
Shape blade(const Stem& stem, float size, float droop) {
    const vec3 tip = stem.at(1), out = stem.tip_direction();
    const vec3 side = normalize(cross(out, vec3{0, 1, 0}));
    const vec3 up = cross(side, out);
    const auto point = [=](float u, float v) {
        const float x = 2 * u - 1;
        const float width =
            0.36f * size * std::pow(std::max(0.0f, std::sin(kPi * std::pow(v, 0.75f))), 0.8f);
        const float fold = 0.20f * std::abs(x) * width;
        const float wave = 0.12f * width * std::sin(9 * v) * x;
        const vec3 rib =
            tip + out * (size * v * (1 - 0.25f * v * droop)) - up * (size * droop * v * v * 0.7f);
        return rib + side * (x * width) + up * (fold + wave);
    };
    return sheet(point, 4, 9);
}

}  // namespace

void add_plant(SceneBuilder& scene) {
    const int earth = scene.diffuse("earth", {0.045f, 0.03f, 0.02f});
    const int terracotta = scene.diffuse("terracotta", {0.42f, 0.17f, 0.09f});
    const int stalk = scene.diffuse("stalk", {0.13f, 0.19f, 0.06f});
    const int leaf = scene.diffuse("leaf", {0.075f, 0.165f, 0.055f});
    scene.material(leaf).double_sided = true;

    Dice dice(3);
    Shape stems, leaves;
    for (int i = 0; i < kStemCount; ++i) {
        constexpr float kGoldenAngle = 2.39996323f;  // spreads leaves evenly, as plants do
        const float inner = static_cast<float>(i) / kStemCount;  // 0: outermost and lowest
        const Stem stem{kGoldenAngle * static_cast<float>(i) + dice.between(-0.2f, 0.2f),
                        0.30f - 0.22f * inner + dice.between(-0.03f, 0.03f),
                        0.22f + 0.55f * inner + dice.between(-0.05f, 0.05f)};
        stems.append(stem_tube(stem));
        leaves.append(blade(stem, dice.between(0.18f, 0.27f), dice.between(0.5f, 1.0f)));
    }
    const vec3 at{1.22f, 0, room::kHalfZ - 0.42f};
    scene.add("plant", {{pot().moved(at), terracotta},
                        {soil().moved(at), earth},
                        {stems.moved(at), stalk},
                        {leaves.moved(at), leaf}});
}

}  // namespace aglow::builtin
