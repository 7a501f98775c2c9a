// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/toys.h"

#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr int kKeys = 16;  // of a loop

std::vector<float> key_times() {
    std::vector<float> times;
    for (int k = 0; k <= kKeys; ++k) times.push_back(kToyLoop * static_cast<float>(k) / kKeys);
    return times;
}

/// Values at the keys of something that swings `count` times a loop.
std::vector<float> swings(const std::function<std::vector<float>(float phase)>& value, int count) {
    std::vector<float> all;
    for (int k = 0; k <= kKeys; ++k) {
        const std::vector<float> more =
            value(2 * kPi * static_cast<float>(count * (k % kKeys)) / kKeys);
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

std::vector<float> numbers(vec4 q) { return {q.x, q.y, q.z, q.w}; }

float blend(float lo, float hi, float x) {
    const float t = std::clamp((x - lo) / (hi - lo), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// A closed hull: a ball with its upper half pressed flat and both ends drawn out.
Shape hull() {
    Shape shape = sphere({0, 0, 0}, 1, 32, 20);
    for (vec3& p : shape.positions) {
        const float taper = 1 - 0.25f * p.z * p.z;
        p = {0.055f * p.x * taper, p.y > 0 ? 0.012f * p.y + 0.02f * p.z * p.z : 0.055f * p.y,
             0.15f * p.z};
    }
    return soup_to_shape(std::move(shape), 50).moved({0, 0.055f, 0});
}

Shape sail() {
    return sheet(
        [](float u, float v) {
            const float width = 0.12f * (1 - v);
            return vec3{0.015f * std::sin(kPi * u) * (1 - v), 0.09f + 0.2f * v, 0.012f + width * u};
        },
        12, 16);
}

Shape duck_body() {
    Shape shape = sphere({0, 0, 0}, 1, 32, 22);
    for (vec3& p : shape.positions) {  // drawn up into a tail behind, at -Z
        const float tail = blend(-0.3f, -1, p.z);
        p = {0.075f * p.x * (1 - 0.7f * tail), 0.062f * p.y * (1 - 0.5f * tail) + 0.055f * tail,
             0.105f * p.z};
    }
    return soup_to_shape(std::move(shape), 70).moved({0, 0.062f, 0});
}

}  // namespace

void add_boat(SceneBuilder& scene, vec3 place) {
    const int blue = scene.glossy("blue paint", {0.04f, 0.14f, 0.42f}, 0.15f);
    const int pine = scene.glossy("pine", {0.6f, 0.42f, 0.22f}, 0.4f);
    const int cloth = scene.diffuse("cloth", {0.75f, 0.72f, 0.66f});
    scene.material(cloth).double_sided = true;
    const int boat = scene.add(
        "boat", {{hull(), blue}, {cylinder({0, 0.06f, -0.005f}, 0.005f, 0.25f, 12), pine}});
    scene.node(boat).translation = place;
    const int canvas = scene.add("sail", sail(), cloth);
    scene.attach(canvas, boat);
    add_target(scene.mesh(scene.node(canvas).mesh).primitives[0], [](vec3 p) {
        const float height = (p.y - 0.09f) / 0.2f, out = (p.z - 0.012f) / 0.12f;
        return p + vec3{0.22f * out * (1 - height), 0, -0.35f * out * 0.1f};
    });
    scene.mesh(scene.node(canvas).mesh).weights = {0.3f};
    const auto rock = [](float phase) {
        return numbers(then(turn({0, 0, 1}, 9 * std::sin(phase)),
                            then(turn({1, 0, 0}, 4 * std::cos(phase)), turn({0, 1, 0}, 35))));
    };
    scene.animate(boat, Path::rotation, key_times(), swings(rock, 2));
    const auto billow = [](float phase) {
        return std::vector<float>{0.35f + 0.35f * std::sin(phase)};
    };
    scene.animate(canvas, Path::weights, key_times(), swings(billow, 2));
}

void add_duck(SceneBuilder& scene, vec3 place, float heading_degrees) {
    const int yellow = scene.glossy("yellow rubber", {0.78f, 0.56f, 0.05f}, 0.2f);
    const int orange = scene.glossy("orange rubber", {0.75f, 0.25f, 0.03f}, 0.25f);
    const int black = scene.glossy("eye", {0.02f, 0.02f, 0.02f}, 0.05f);
    Shape skin = duck_body();
    skin.append(sphere({0, 0.155f, 0.06f}, 0.052f, 24, 16));
    const Shape beak =
        sphere({0, 0, 0}, 1, 16, 10).scaled({0.026f, 0.009f, 0.032f}).moved({0, 0.148f, 0.115f});
    Shape eyes = sphere({0.03f, 0.172f, 0.098f}, 0.009f, 12, 8);
    eyes.append(sphere({-0.03f, 0.172f, 0.098f}, 0.009f, 12, 8));
    const int duck = scene.add("duck", {{skin, yellow}, {beak, orange}, {eyes, black}});
    Mesh& mesh = scene.mesh(scene.node(duck).mesh);
    for (Primitive& primitive : mesh.primitives) {
        add_target(primitive, [](vec3 p) {  // breathes in: the breast swells, the head is raised
            const float belly = 1 - blend(0.08f, 0.13f, p.y), head = blend(0.09f, 0.13f, p.y);
            const vec3 out = (p - vec3{0, 0.05f, 0.01f}) * (0.22f * belly);
            return p + vec3{out.x, std::max(out.y, 0.0f), out.z} + vec3{0, 0.018f * head, 0};
        });
        add_target(primitive, [](vec3 p) {  // bows its head
            const float head = blend(0.1f, 0.14f, p.y);
            return p + vec3{0, -0.4f * head * std::max(0.0f, p.z - 0.03f), 0.03f * head};
        });
    }
    mesh.weights = {0, 0};
    scene.node(duck).translation = place;
    scene.node(duck).rotation = turn({0, 1, 0}, heading_degrees);
    const auto breathe = [](float phase) {
        return std::vector<float>{0.5f - 0.5f * std::cos(2 * phase),
                                  std::max(0.0f, std::sin(phase))};
    };
    scene.animate(duck, Path::weights, key_times(), swings(breathe, 1));
}

Scene toys() {
    SceneBuilder scene("toys");
    const int floor = scene.diffuse("floor", {0.3f, 0.28f, 0.26f});
    const int table = scene.textured(painted("table", 128, 128, [](float u, float v) {
        const float ring = std::sin(60 * u + 4 * std::sin(5 * v) + 2 * std::sin(17 * u * v));
        return vec3{0.5f, 0.33f, 0.19f} * (0.88f + 0.12f * ring);
    }));
    scene.material(table).roughness = 0.25f;
    add_studio(scene,
               {.half = 1.4f,
                .height = 2.2f,
                .floor_height = -0.5f,
                .spot = vec3{3000, 2850, 2600},
                .spot_position = {1.0f, 1.35f, 0.9f},
                .spot_target = {0, 0, 0}},
               floor);
    scene.look({0.38f, 0.62f, 0.95f}, {0, 0.03f, 0}, 42);
    scene.add("table", rounded_box({-0.75f, -0.04f, -0.65f}, {0.75f, 0, 0.65f}, 0.015f, 2), table);
    add_train(scene);
    add_boat(scene, {-0.12f, 0, -0.12f});
    add_duck(scene, {0.14f, 0, 0.08f}, 20);
    return scene.take();
}

}  // namespace aglow::builtin
