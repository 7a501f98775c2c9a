// SPDX-License-Identifier: Apache-2.0
// A ball whose shell flies apart: each triangle by itself, on a path of its own. The shell gathers
// into two linked rings and closes again about the core. Three morph targets carry it: a cloud, the
// rings, and another cloud; between two of them every triangle crosses the ways of many others.
#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aglow::builtin {
namespace {

constexpr float kBall = 0.5f;         // m, radius
constexpr vec3 kCenter{0, 0.85f, 0};  // m
constexpr int kSlices = 112, kStacks = 56;

struct Corners {
    vec3 a, b, c;
    vec3 center() const { return (a + b + c) / 3; }
    vec3 normal() const { return normalize(cross(b - a, c - a)); }
};

std::vector<Corners> corners_of(const Shape& shape) {
    std::vector<Corners> all;
    for (const uvec3 t : shape.triangles)
        all.push_back({shape.positions[t.x], shape.positions[t.y], shape.positions[t.z]});
    return all;
}

template <class T>
void shuffle(std::vector<T>& items, Dice& dice) {
    for (size_t i = items.size(); i > 1; --i) {
        const auto k = static_cast<size_t>(dice.next() * static_cast<float>(i));
        std::swap(items[i - 1], items[std::min(k, i - 1)]);
    }
}

vec3 unit_vector(Dice& dice) {
    const float z = dice.between(-1, 1), angle = 2 * kPi * dice.next();
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The triangle turned at random about its centre, which is moved to `center`.
Corners thrown(const Corners& t, vec3 center, Dice& dice) {
    const vec3 axis = unit_vector(dice);
    const float angle = 360 * dice.next();
    Shape shape;
    shape.positions = {t.a - t.center(), t.b - t.center(), t.c - t.center()};
    shape = shape.turned(axis, angle).moved(center);
    return {shape.positions[0], shape.positions[1], shape.positions[2]};
}

std::vector<Corners> cloud(const std::vector<Corners>& rest, float spread, Dice& dice) {
    std::vector<Corners> all;
    for (const Corners& t : rest) {
        const vec3 out = unit_vector(dice) * (spread * std::cbrt(dice.next()));
        const vec3 center = kCenter + vec3{out.x, 0.8f * out.y, out.z};
        all.push_back(thrown(t, center, dice));
    }
    return all;
}

Shape ring(int slices, int sides) {
    std::vector<vec2> profile;
    for (int i = 0; i < sides; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(sides);
        profile.push_back({0.5f + 0.15f * std::cos(angle), 0.15f * std::sin(angle)});
    }
    profile.push_back(profile.front());
    return lathe(profile, slices);
}

/// Two linked rings of at least `count` triangles, in random order.
std::vector<Corners> linked_rings(size_t count, Dice& dice) {
    const auto sides = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count) / 16)));
    const Shape one = ring(4 * sides, sides).turned({1, 0, 0}, 70).moved({-0.25f, 0, 0});
    const Shape other = ring(4 * sides, sides).turned({1, 0, 0}, -20).moved({0.25f, 0, 0});
    std::vector<Corners> all = corners_of(one.moved(kCenter));
    const std::vector<Corners> more = corners_of(other.moved(kCenter));
    all.insert(all.end(), more.begin(), more.end());
    shuffle(all, dice);
    return all;
}

void push(Primitive& primitive, const Corners& t) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    for (const vec3 p : {t.a, t.b, t.c}) primitive.positions.push_back(p);
    primitive.normals.insert(primitive.normals.end(), 3, t.normal());
    primitive.triangles.push_back({first, first + 1, first + 2});
}

void push(MorphTarget& target, const Corners& from, const Corners& to) {
    for (const vec3 d : {to.a - from.a, to.b - from.b, to.c - from.c})
        target.positions.push_back(d);
    target.normals.insert(target.normals.end(), 3, to.normal() - from.normal());
}

/// The shell in two colours, by bands of the ball; every triangle has corners of its own.
void fill_shell(Mesh& mesh) {
    const std::vector<Corners> rest = corners_of(sphere(kCenter, kBall, kSlices, kStacks));
    Dice dice(17);
    const std::array<std::vector<Corners>, 3> goals = {
        cloud(rest, 1.05f, dice), linked_rings(rest.size(), dice), cloud(rest, 0.8f, dice)};
    for (Primitive& primitive : mesh.primitives) primitive.targets.resize(goals.size());
    for (size_t i = 0; i < rest.size(); ++i) {
        const vec3 out = rest[i].center() - kCenter;
        const float turn = std::atan2(out.z, out.x) / (2 * kPi) + 0.5f;
        const bool light = static_cast<int>(turn * 12 + 3 * (out.y / kBall + 1)) % 2 == 0;
        Primitive& primitive = mesh.primitives[light ? 0 : 1];
        push(primitive, rest[i]);
        for (size_t g = 0; g < goals.size(); ++g) push(primitive.targets[g], rest[i], goals[g][i]);
    }
    mesh.weights.assign(goals.size(), 0);
}

/// Rest, cloud, rings, cloud, rest; it halts at each. A spline without slope at its keys.
void animate(SceneBuilder& scene, int shell) {
    constexpr std::array<float, 8> kTimes = {0, 0.4f, 1.4f, 2.4f, 2.9f, 3.8f, 4.8f, 5};
    constexpr std::array<int, 8> kGoals = {-1, -1, 0, 1, 1, 2, -1, -1};
    std::vector<float> values;
    for (const int goal : kGoals)
        for (int part = 0; part < 3; ++part)  // in-tangent, value, out-tangent
            for (int target = 0; target < 3; ++target)
                values.push_back(part == 1 && target == goal ? 1.0f : 0.0f);
    scene.animate(shell, Path::weights, {kTimes.begin(), kTimes.end()}, std::move(values),
                  Interpolation::cubic_spline);
}

}  // namespace

Scene scatter() {
    SceneBuilder scene("scatter");
    const int floor = scene.glossy("floor", {0.4f, 0.4f, 0.42f}, 0.15f);
    add_studio(scene,
               {.half = 2.2f,
                .height = 3,
                .spot = vec3{9000, 8500, 7700},
                .spot_position = {1.8f, 2.8f, 1.5f},
                .spot_target = kCenter},
               floor);
    scene.look({1.6f, 1.35f, 2.3f}, {0, 0.78f, 0}, 45);
    const int core = scene.metal("core", {0.85f, 0.65f, 0.35f}, 0.08f);
    scene.add("core", sphere(kCenter, 0.22f, 32, 16), core);
    scene.add("foot", cylinder({0, 0, 0}, 0.05f, kCenter.y - 0.2f, 24), core);
    const int light = scene.glossy("light shell", {0.75f, 0.72f, 0.66f}, 0.4f);
    const int dark = scene.glossy("dark shell", {0.08f, 0.22f, 0.4f}, 0.3f);
    scene.material(light).double_sided = true;
    scene.material(dark).double_sided = true;
    const Shape none;
    const int shell = scene.add("shell", {{none, light}, {none, dark}});
    fill_shell(scene.mesh(scene.node(shell).mesh));
    animate(scene, shell);
    return scene.take();
}

}  // namespace aglow::builtin
