// SPDX-License-Identifier: Apache-2.0
// Three framed pictures over the sofa.
#include "aglow/scene/builtin/room.h"

#include <cmath>

namespace aglow::builtin {
namespace {

constexpr vec3 kPaper{0.76f, 0.73f, 0.66f};

/// Hills behind each other under a low sun.
vec3 hills(float u, float v) {
    const auto ridge = [&](float base, float height, float wave, float phase) {
        return base -
               height * (std::sin(wave * u + phase) + 0.4f * std::sin(2.7f * wave * u + phase));
    };
    if (v > ridge(0.84f, 0.04f, 5, 2.1f)) return {0.035f, 0.075f, 0.065f};
    if (v > ridge(0.70f, 0.05f, 4, 0.4f)) return {0.09f, 0.16f, 0.14f};
    if (v > ridge(0.56f, 0.06f, 6, 3.3f)) return {0.24f, 0.31f, 0.28f};
    const float du = u - 0.64f, dv = (v - 0.34f) * 1.25f;
    if (du * du + dv * dv < 0.013f) return {0.66f, 0.26f, 0.08f};
    return shared::mix(vec3{0.70f, 0.54f, 0.36f}, vec3{0.58f, 0.60f, 0.56f}, 1 - v);
}

/// Overlapping discs and a bar, in few colours.
vec3 discs(float u, float v) {
    const auto in_disc = [&](float x, float y, float radius) {
        return std::hypot(u - x, (v - y) * 1.25f) < radius;
    };
    const bool large = in_disc(0.42f, 0.40f, 0.27f), small = in_disc(0.66f, 0.62f, 0.17f);
    if (large && small) return {0.10f, 0.05f, 0.045f};
    if (small) return {0.055f, 0.14f, 0.20f};
    if (large) return {0.55f, 0.20f, 0.08f};
    if (u > 0.16f && u < 0.84f && std::abs(v - 0.84f) < 0.012f) return {0.06f, 0.06f, 0.06f};
    return kPaper;
}

/// A stem with leaves to both sides.
vec3 botanical(float u, float v) {
    const float stem = 0.5f + 0.05f * std::sin(4 * v);
    for (int i = 0; i < 7; ++i) {
        const float y = 0.20f + 0.09f * static_cast<float>(i), side = i % 2 == 0 ? 1.0f : -1.0f;
        const float x = side * (u - 0.5f - 0.05f * std::sin(4 * y));
        const float along = x * 0.87f - (v - y) * 1.25f * 0.5f,
                    across = x * 0.5f + (v - y) * 1.25f * 0.87f;
        const float length = 0.30f - 0.018f * std::abs(static_cast<float>(i) - 4);
        if (along < 0 || along > length) continue;
        const float half = 0.28f * length * std::sin(kPi * std::pow(along / length, 0.8f));
        if (std::abs(across) < 0.003f) return {0.16f, 0.24f, 0.12f};
        if (std::abs(across) < half) return {0.065f, 0.155f, 0.075f};
    }
    if (v > 0.14f && v < 0.92f && std::abs(u - stem) < 0.006f) return {0.12f, 0.16f, 0.07f};
    return kPaper;
}

/// The image inside a broad paper mount.
vec3 mounted(float u, float v, vec3 (*image)(float, float)) {
    constexpr float kMount = 0.14f;
    const float x = (u - kMount) / (1 - 2 * kMount), y = (v - kMount) / (1 - 2 * kMount);
    if (x < 0 || x > 1 || y < 0 || y > 1) return {0.80f, 0.79f, 0.76f};
    return image(x, y);
}

/// Four bars around an opening, mitred by the lattice into one solid, facing +Z.
Shape frame(float width, float height) {
    constexpr float kBar = 0.022f, kDepth = 0.026f, kSink = 0.003f;  // m
    const float x = width / 2, y = height / 2;
    Lattice bars;
    bars.x = {-x, -x + kBar, x - kBar, x};
    bars.y = {-y, -y + kBar, y - kBar, y};
    bars.z = {-kSink, kDepth};
    bars.solid = [](int i, int j, int k) {
        const bool inside = i >= 0 && i < 3 && j >= 0 && j < 3 && k == 0;
        return inside && (i != 1 || j != 1);
    };
    return bars.shape();
}

void add_picture(SceneBuilder& scene, const std::string& name, vec3 (*image)(float, float), float z,
                 int frame_paint) {
    constexpr float kWidth = 0.46f, kHeight = 0.58f, kCenterY = 1.50f, kProud = 0.008f;
    const auto color = [image](float u, float v) { return mounted(u, v, image); };
    const int print = scene.textured(painted(name, 256, 256, color));
    const float x = kWidth / 2 - 0.02f, y = kHeight / 2 - 0.02f;
    const Shape sheet_of_paper =
        quad({-x, -y, kProud}, {x, -y, kProud}, {x, y, kProud}, {-x, y, kProud});
    const auto hang = [&](const Shape& shape) {
        return shape.turned({0, 1, 0}, -90).moved({room::kHalfX, kCenterY, z});
    };
    scene.add("picture of " + name,
              {{hang(sheet_of_paper), print}, {hang(frame(kWidth, kHeight)), frame_paint}});
}

}  // namespace

void add_pictures(SceneBuilder& scene, const room::Paints& paints) {
    add_picture(scene, "hills", hills, -0.14f, paints.oak);
    add_picture(scene, "discs", discs, 0.45f, paints.black);
    add_picture(scene, "leaves", botanical, 1.04f, paints.oak);
}

}  // namespace aglow::builtin
