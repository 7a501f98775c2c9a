// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/machine_parts.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

float fraction(int i, int count) { return static_cast<float>(i) / static_cast<float>(count); }

Shape bolt(int slices) {
    const std::array<vec2, 7> shaft = {vec2{0, -0.5f}, {0.13f, -0.5f}, {0.16f, -0.46f},
                                       {0.16f, 0.2f},  {0.3f, 0.2f},   {0.3f, 0.24f},
                                       {0, 0.24f}};
    const std::array<vec2, 5> head = {
        vec2{0, 0.24f}, {0.27f, 0.24f}, {0.27f, 0.44f}, {0.22f, 0.5f}, {0, 0.5f}};
    Shape shape = lathe(shaft, slices);
    shape.append(lathe(head, 6));
    return shape;
}

/// A toothed disc with a bore. Outline points come in fours: root, root, tip, tip.
Shape gear(int teeth) {
    const int count = 4 * teeth;
    constexpr float kHalf = 0.14f, kBore = 0.16f, kRoot = 0.4f, kTip = 0.5f;  // of the cube's edge
    const auto at = [&](int i, float radius, float y) {
        const float angle = 2 * kPi * fraction(i % count, count);
        return vec3{radius * std::cos(angle), y, -radius * std::sin(angle)};
    };
    const auto outline = [&](int i) { return i % 4 < 2 ? kRoot : kTip; };
    Shape soup;
    const auto face = [&](vec3 a, vec3 b, vec3 c, vec3 d) {
        const auto first = static_cast<uint32_t>(soup.positions.size());
        for (const vec3 p : {a, b, c, d}) {
            soup.positions.push_back(p);
            soup.texcoords.push_back({p.x, p.z});
        }
        soup.triangles.push_back({first, first + 1, first + 2});
        soup.triangles.push_back({first, first + 2, first + 3});
    };
    for (int i = 0; i < count; ++i) {
        const int k = (i + 1) % count;
        const float r = outline(i), s = outline(k);
        face(at(i, r, -kHalf), at(k, s, -kHalf), at(k, s, kHalf), at(i, r, kHalf));
        face(at(k, kBore, -kHalf), at(i, kBore, -kHalf), at(i, kBore, kHalf), at(k, kBore, kHalf));
        face(at(i, kBore, kHalf), at(i, r, kHalf), at(k, s, kHalf), at(k, kBore, kHalf));
        face(at(i, kBore, -kHalf), at(k, kBore, -kHalf), at(k, s, -kHalf), at(i, r, -kHalf));
    }
    return soup_to_shape(std::move(soup), 30);
}

/// Two elbows between two flanges.
Shape pipe(int slices, int steps) {
    std::vector<vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= steps; ++i) {
        const float t = fraction(i, steps), y = 0.47f - 0.94f * t;
        const float bend =
            0.5f - 0.5f * std::cos(kPi * std::min(1.0f, std::max(0.0f, 2 * t - 0.5f)));
        path.push_back({-0.25f + 0.5f * bend, y, 0});
        radii.push_back(0.14f);
    }
    Shape shape = tube(path, radii, slices);
    shape.append(cylinder({-0.25f, 0.4f, 0}, 0.24f, 0.1f, slices));
    shape.append(cylinder({0.25f, -0.5f, 0}, 0.24f, 0.1f, slices));
    return shape;
}

Shape ring(int slices, int sides) {
    std::vector<vec2> profile;
    for (int i = 0; i < sides; ++i) {
        const float angle = 2 * kPi * fraction(i, sides);
        profile.push_back({0.36f + 0.13f * std::cos(angle), 0.13f * std::sin(angle)});
    }
    profile.push_back(profile.front());
    return lathe(profile, slices);
}

Shape spring(int sides, int steps_per_turn) {
    constexpr int kTurns = 5;
    const int steps = kTurns * steps_per_turn;
    std::vector<vec3> path;
    for (int i = 0; i <= steps; ++i) {
        const float angle = 2 * kPi * fraction(i, steps_per_turn);
        path.push_back(
            {0.4f * std::cos(angle), 0.88f * fraction(i, steps) - 0.44f, -0.4f * std::sin(angle)});
    }
    return tube(path, std::vector<float>(path.size(), 0.05f), sides);
}

Shape finned_cylinder(int slices, int fins) {
    std::vector<vec2> profile = {{0, -0.5f}, {0.3f, -0.5f}};
    for (int i = 0; i < fins; ++i) {
        const float y = -0.42f + 0.84f * fraction(i, fins), step = 0.84f / static_cast<float>(fins);
        profile.push_back({0.3f, y});
        profile.push_back({0.49f, y});
        profile.push_back({0.49f, y + 0.35f * step});
        profile.push_back({0.3f, y + 0.35f * step});
    }
    profile.push_back({0.3f, 0.5f});
    profile.push_back({0, 0.5f});
    return lathe(profile, slices);
}

}  // namespace

Shape machine_part(MachinePart part, int level) {
    const int fine = 1 << level;
    switch (part) {
        case MachinePart::plate:
            if (level == 0) return box({-0.5f, -0.1f, -0.5f}, {0.5f, 0.1f, 0.5f});
            return rounded_box({-0.5f, -0.1f, -0.5f}, {0.5f, 0.1f, 0.5f}, 0.06f, fine / 2);
        case MachinePart::bolt:
            return bolt(4 * fine);
        case MachinePart::gear:
            return gear(6 * fine);
        case MachinePart::pipe:
            return pipe(6 * fine, 6 * fine);
        case MachinePart::ring:
            return ring(10 * fine, 5 * fine);
        case MachinePart::spring:
            return spring(3 * fine, 6 * fine);
        case MachinePart::finned_cylinder:
            break;
    }
    return finned_cylinder(8 * fine, 3 + 2 * level);
}

}  // namespace aglow::builtin
