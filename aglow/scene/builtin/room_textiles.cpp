// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/room.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

using room::kHalfZ;

float fract(float v) { return v - std::floor(v); }

/// Distance to the nearest integer, 0..0.5.
float fold(float v) { return std::abs(v - std::floor(v + 0.5f)); }

/// Woven rug: a field of nested diamonds between striped borders.
vec3 rug_color(float u, float v) {
    constexpr vec3 kCream{0.62f, 0.55f, 0.44f}, kRed{0.36f, 0.075f, 0.05f},
        kBlue{0.045f, 0.085f, 0.17f}, kGold{0.48f, 0.29f, 0.07f};
    const float edge = std::min(std::min(u, 1 - u) * 1.5f, std::min(v, 1 - v) * 2.2f);
    const float weave = 0.9f + 0.1f * std::sin(u * 1400) * std::sin(v * 1900);
    if (edge < 0.04f) return kRed * weave;
    if (edge < 0.06f) return kGold * weave;
    if (edge < 0.15f)  // a band of small triangles
        return ((edge - 0.06f) / 0.09f < 2 * fold(u * 14) * 2 * fold(v * 19) * 2 + 0.15f ? kBlue
                                                                                         : kCream) *
               weave;
    if (edge < 0.17f) return kGold * weave;
    const float diamond = fold(u * 3) * 2 + fold(v * 4) * 2;
    const float ring = fract(diamond * 2.5f);
    if (diamond < 0.35f) return (diamond < 0.16f ? kGold : kBlue) * weave;
    if (ring < 0.22f) return kCream * weave;
    return (diamond > 1.4f ? kBlue : kRed) * weave;
}

void add_rug(SceneBuilder& scene) {
    constexpr vec3 kLo{-0.15f, -0.003f, -0.95f}, kHi{1.55f, 0.011f, 1.70f};
    const int paint = scene.textured(painted("rug", 512, 1024, rug_color));
    Shape rug = rounded_box(kLo, kHi, 0.006f, 2);
    for (size_t i = 0; i < rug.positions.size(); ++i)
        rug.texcoords[i] = {(rug.positions[i].x - kLo.x) / (kHi.x - kLo.x),
                            (rug.positions[i].z - kLo.z) / (kHi.z - kLo.z)};
    scene.add("rug", rug, paint);
}

/// Hanging cloth from x0 to x1, gathered into `folds` waves that open towards the hem.
Shape curtain(float x0, float x1, float folds, float phase) {
    constexpr float kTop = 2.52f, kHem = 0.025f, kFoldDepth = 0.048f;
    const auto point = [=](float u, float v) {
        const float fall = 1 - v;  // 0 at the rod, 1 at the hem
        const float angle = 2 * kPi * folds * u + phase + 0.5f * std::sin(3.1f * u + 2.2f * fall);
        const float depth = kFoldDepth * (0.55f + 0.45f * fall);
        const float sway = 0.012f * std::sin(5 * u + 3 * fall + phase);
        const float x = shared::mix(x0, x1, u) - 0.14f * depth * std::sin(2 * angle);
        return vec3{x, shared::mix(kHem, kTop, v),
                    kHalfZ - 0.115f + depth * std::sin(angle) + sway};
    };
    return sheet(point, 72, 12);
}

Shape rod() {
    constexpr float kY = 2.53f, kZ = kHalfZ - 0.115f, kEnd = 2.44f;
    const std::array<vec3, 2> path = {vec3{-kEnd, kY, kZ}, {kEnd, kY, kZ}};
    const std::array<float, 2> radii = {0.012f, 0.012f};
    Shape shape = tube(path, radii, 16);
    for (const float x : {-2.25f, 0.0f, 2.25f}) {
        const std::array<vec3, 2> arm = {vec3{x, kY, kZ}, {x, kY, kHalfZ + 0.004f}};
        const std::array<float, 2> arm_radii = {0.008f, 0.008f};
        shape.append(tube(arm, arm_radii, 10));
    }
    return shape;
}

/// Blanket over the sofa's southern arm: short on the seat's side, long on the outer one.
Shape blanket() {
    constexpr float kArmZ = 1.335f, kArmTop = 0.615f, kHalfArm = 0.098f;
    constexpr float kInner = -0.235f,
                    kOuter = 0.50f;  // m of cloth to both sides of the arm's ridge
    const auto point = [=](float u, float v) {
        const float run = shared::mix(kInner, kOuter, v);
        const float over = std::clamp(run, -kHalfArm, kHalfArm);
        const float drop = std::abs(run) - std::abs(over);
        const float hang = std::min(1.0f, drop / 0.05f);  // 0 on the arm, 1 where cloth hangs free
        const float round = 0.022f * (over / kHalfArm) * (over / kHalfArm);
        const float ripple = 0.007f * std::sin(19 * u + 2 * v) + 0.003f * std::sin(9 * u - 7 * v);
        const float away = hang * (0.012f + ripple) + 0.03f * drop;
        return vec3{shared::mix(2.12f, 1.72f, u) + 0.02f * std::sin(3 * v),
                    kArmTop + 0.004f + 0.3f * ripple - round - drop,
                    kArmZ + over + std::copysign(away, run)};
    };
    return sheet(point, 16, 36);
}

}  // namespace

void add_textiles(SceneBuilder& scene, const room::Paints& paints) {
    add_rug(scene);
    const int cloth = scene.diffuse("curtain", {0.76f, 0.72f, 0.64f});
    scene.material(cloth).double_sided = true;
    int number = 1;
    struct Span {
        float x0, x1;
    };
    for (const Span s : {Span{-2.43f, -2.02f}, {-0.40f, -0.03f}, {0.03f, 0.40f}, {2.02f, 2.43f}}) {
        const float phase = 0.9f * static_cast<float>(number);
        scene.add("curtain " + std::to_string(number++), curtain(s.x0, s.x1, 4.5f, phase), cloth);
    }
    scene.add("curtain rod", rod(), paints.black);
    const int wool = scene.diffuse("blanket", {0.52f, 0.40f, 0.30f});
    scene.material(wool).double_sided = true;
    scene.add("blanket", blanket(), wool);
}

}  // namespace aglow::builtin
