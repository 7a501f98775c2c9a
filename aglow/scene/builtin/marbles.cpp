// SPDX-License-Identifier: Apache-2.0
// Marbles that roll in a tray and knock against each other and its rim. Without friction they obey
// laws that are the same forward and backward in time; so the motion swings from rest to rest and
// back again, as in a tray that is tilted to and fro, and joins on to itself.
#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr float kRadius = 0.05f;                 // m
constexpr float kHalfX = 0.42f, kHalfZ = 0.30f;  // m, of the tray's inside
constexpr float kPeriod = 4;                     // seconds there and back
constexpr int kKeys = 96;                        // of a period
constexpr int kStepsPerKey = 20;
constexpr float kTravelTime = 1.6f;  // seconds of free motion that are swept
constexpr int kColumns = 4, kRows = 4;

struct Marble {
    vec2 place, speed;  ///< m and m/s along x and z
    vec4 rotation = {0, 0, 0, 1};
};
using Marbles = std::array<Marble, kColumns * kRows>;

Marbles rack() {
    Marbles marbles;
    Dice dice(5);
    for (size_t i = 0; i < marbles.size(); ++i) {
        const auto column = static_cast<float>(i % kColumns),
                   row = static_cast<float>(i / kColumns);
        marbles[i].place = {(column - 0.5f * (kColumns - 1)) * 0.19f + dice.between(-0.02f, 0.02f),
                            (row - 0.5f * (kRows - 1)) * 0.14f + dice.between(-0.012f, 0.012f)};
        marbles[i].speed = {dice.between(-0.7f, 0.7f), dice.between(-0.6f, 0.6f)};
        marbles[i].rotation = turn({dice.next(), 0.3f, dice.next()}, 360 * dice.next());
    }
    return marbles;
}

/// Equal masses swap what they have of speed along the line between them.
void collide(Marble& a, Marble& b) {
    const vec2 between = b.place - a.place;
    const float distance = length(between);
    if (distance >= 2 * kRadius || distance == 0) return;
    const vec2 n = between / distance;
    const float approach = dot(a.speed - b.speed, n);
    if (approach <= 0) return;
    a.speed = a.speed - n * approach;
    b.speed = b.speed + n * approach;
}

void roll(Marbles& marbles, float seconds) {
    for (Marble& m : marbles) {
        const vec2 step = m.speed * seconds;
        m.place = m.place + step;
        if (const float way = length(step); way > 0)  // rolls about the axis across its way
            m.rotation = then(m.rotation, turn({step.y, 0, -step.x}, way / kRadius * 180 / kPi));
        if (std::abs(m.place.x) > kHalfX - kRadius && m.place.x * m.speed.x > 0)
            m.speed.x = -m.speed.x;
        if (std::abs(m.place.y) > kHalfZ - kRadius && m.place.y * m.speed.y > 0)
            m.speed.y = -m.speed.y;
    }
    for (size_t i = 0; i < marbles.size(); ++i)
        for (size_t k = i + 1; k < marbles.size(); ++k) collide(marbles[i], marbles[k]);
}

/// Free motion seen at the times that a swing from rest to rest passes through: half a period.
std::vector<Marbles> swing() {
    std::vector<Marbles> frames = {rack()};
    Marbles marbles = frames[0];
    const auto swept = [](int key) {
        return kTravelTime * (0.5f - 0.5f * std::cos(2 * kPi * static_cast<float>(key) / kKeys));
    };
    for (int key = 1; key <= kKeys / 2; ++key) {
        const float step = (swept(key) - swept(key - 1)) / kStepsPerKey;
        for (int i = 0; i < kStepsPerKey; ++i) roll(marbles, step);
        frames.push_back(marbles);
    }
    return frames;
}

void animate(SceneBuilder& scene, const std::array<int, kColumns * kRows>& nodes) {
    const std::vector<Marbles> frames = swing();
    std::vector<float> times;
    for (int key = 0; key <= kKeys; ++key)
        times.push_back(kPeriod * static_cast<float>(key) / kKeys);
    for (size_t i = 0; i < nodes.size(); ++i) {
        std::vector<float> places, turns;
        for (int key = 0; key <= kKeys; ++key) {
            const Marble& m = frames[static_cast<size_t>(std::min(key, kKeys - key))][i];
            places.insert(places.end(), {m.place.x, kRadius, m.place.y});
            turns.insert(turns.end(), {m.rotation.x, m.rotation.y, m.rotation.z, m.rotation.w});
        }
        scene.animate(nodes[i], Path::translation, times, std::move(places));
        scene.animate(nodes[i], Path::rotation, times, std::move(turns));
    }
}

Shape rim() {
    constexpr float kWidth = 0.035f, kHeight = 0.07f;
    const vec3 outer{kHalfX + kWidth, kHeight, kHalfZ + kWidth};
    const auto bar = [](vec3 lo, vec3 hi) { return rounded_box(lo, hi, 0.008f, 1); };
    Shape shape = bar({-outer.x, -0.02f, kHalfZ}, {outer.x, kHeight, outer.z});
    shape.append(bar({-outer.x, -0.02f, -outer.z}, {outer.x, kHeight, -kHalfZ}));
    shape.append(bar({kHalfX, -0.02f, -outer.z}, {outer.x, kHeight, outer.z}));
    shape.append(bar({-outer.x, -0.02f, -outer.z}, {-kHalfX, kHeight, outer.z}));
    return shape;
}

TextureImage swirl(std::string name, vec3 light, vec3 dark) {
    return painted(std::move(name), 128, 64, [=](float u, float v) {
        const float wave = std::sin(2 * kPi * (3 * u + 0.8f * std::sin(kPi * v)));
        return wave > 0.2f ? light : dark;
    });
}

std::array<int, 6> marble_materials(SceneBuilder& scene) {
    const std::array<int, 6> materials = {
        scene.textured(swirl("red swirl", {0.75f, 0.72f, 0.66f}, {0.55f, 0.03f, 0.02f})),
        scene.metal("steel", {0.7f, 0.7f, 0.72f}, 0.06f),
        scene.textured(swirl("blue swirl", {0.7f, 0.75f, 0.8f}, {0.02f, 0.08f, 0.5f})),
        scene.textured(swirl("green swirl", {0.75f, 0.7f, 0.2f}, {0.02f, 0.25f, 0.08f})),
        scene.metal("gold", {0.83f, 0.6f, 0.25f}, 0.12f),
        scene.textured(swirl("black swirl", {0.78f, 0.76f, 0.72f}, {0.02f, 0.02f, 0.02f}))};
    for (const int material : materials)
        if (scene.material(material).metallic == 0) scene.material(material).roughness = 0.1f;
    return materials;
}

}  // namespace

Scene marbles() {
    SceneBuilder scene("marbles");
    const int table = scene.diffuse("table", {0.3f, 0.2f, 0.13f});
    const int wood = scene.glossy("wood", {0.35f, 0.19f, 0.09f}, 0.35f);
    const int felt = scene.diffuse("felt", {0.06f, 0.28f, 0.16f});
    add_studio(scene,
               {.half = 1,
                .height = 1.4f,
                .floor_height = -0.02f,
                .spot = vec3{1500, 1420, 1300},
                .spot_position = {0.8f, 1.1f, 0.5f},
                .spot_target = {0, 0, 0}},
               table);
    scene.look({0.42f, 0.66f, 0.88f}, {0, 0, 0.02f}, 40);
    scene.add("tray",
              {{box({-kHalfX, -0.015f, -kHalfZ}, {kHalfX, 0, kHalfZ}), felt}, {rim(), wood}});
    const std::array<int, 6> materials = marble_materials(scene);
    std::array<int, 6> meshes{};
    for (size_t i = 0; i < meshes.size(); ++i)
        meshes[i] = scene.add_mesh("marble " + std::to_string(i),
                                   {{sphere({0, 0, 0}, kRadius, 24, 12), materials[i]}});
    std::array<int, kColumns * kRows> nodes{};
    for (size_t i = 0; i < nodes.size(); ++i)
        nodes[i] = scene.add_node("marble " + std::to_string(i), meshes[(7 * i + i / 4) % 6]);
    animate(scene, nodes);
    return scene.take();
}

}  // namespace aglow::builtin
