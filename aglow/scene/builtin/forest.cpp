// SPDX-License-Identifier: Apache-2.0
// A glade with a pond: a large ground and very many leaves and blades of grass. Crowns sway as
// rigid bodies, grass bends by morph targets.
#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/builtin/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr float kHalf = 20;    // m, of the ground's side
constexpr float kPond = 3.4f;  // m, radius
constexpr vec3 kPondCenter{0.4f, -0.16f, 1};
constexpr int kTrees = 24, kCrowns = 5, kLeaves = 420;
constexpr int kPatches = 28, kBlades = 1000;
constexpr int kShapes = 3;  // meshes of each kind, which many nodes share
constexpr float kLoop = 4;  // seconds
constexpr int kKeys = 16;
constexpr vec3 kWind{0.93f, 0, 0.36f};

float ground_height(float x, float z) {
    const float dx = x - kPondCenter.x, dz = z - kPondCenter.z;
    const float dip = std::exp(-(dx * dx + dz * dz) / (0.8f * kPond * kPond));
    return 0.3f * std::sin(0.23f * x + 1) * std::sin(0.19f * z) * (1 - dip) - 0.7f * dip;
}

vec3 on_ground(float x, float z) { return {x, ground_height(x, z), z}; }

float distance_to_pond(float x, float z) {
    return length(vec2{x - kPondCenter.x, z - kPondCenter.z});
}

void add_corner(Shape& soup, vec3 p, vec2 uv) {
    soup.positions.push_back(p);
    soup.texcoords.push_back(uv);
}

/// Two triangles a b c and a c d.
void add_blade(Shape& soup, vec3 a, vec3 b, vec3 c, vec3 d) {
    const auto first = static_cast<uint32_t>(soup.positions.size());
    add_corner(soup, a, {0, 1}), add_corner(soup, b, {1, 1});
    add_corner(soup, c, {1, 0}), add_corner(soup, d, {0, 0});
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.triangles.push_back({first, first + 2, first + 3});
}

vec3 unit_vector(Dice& dice) {
    const float z = dice.between(-1, 1), angle = 2 * kPi * dice.next();
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

/// A cloud of leaves about the origin, thickest near its rim; each leaf is folded at its midrib.
Shape crown(Dice& dice) {
    Shape soup;
    for (int i = 0; i < kLeaves; ++i) {
        const vec3 out = unit_vector(dice);
        const vec3 foot = out * vec3{1.25f, 0.95f, 1.25f} * std::sqrt(dice.between(0.25f, 1));
        const vec3 along = normalize(out + unit_vector(dice) * 0.9f);
        const Frame frame(along);
        const float size = dice.between(0.2f, 0.34f);
        const vec3 side = frame.tangent * (0.28f * size), up = frame.bitangent * (0.12f * size);
        const vec3 middle = foot + along * (0.45f * size);
        add_blade(soup, foot, middle + side + up, foot + along * size, middle - side + up);
    }
    return soup_to_shape(std::move(soup), 60);
}

Shape trunk(float height, Dice& dice) {
    std::array<vec3, 7> path{};
    std::array<float, 7> radii{};
    for (size_t i = 0; i < path.size(); ++i) {
        const float t = static_cast<float>(i) / 6;
        path[i] = {0.1f * std::sin(3 * t), -0.3f + (height + 0.3f) * t,
                   0.08f * std::sin(4 * t + 1)};
        radii[i] = 0.19f - 0.14f * t + 0.12f * std::exp(-9 * t);
    }
    Shape shape = tube(path, radii, 12);
    for (int i = 0; i < kCrowns; ++i) {
        const float angle = 2.4f * static_cast<float>(i) + dice.between(-0.3f, 0.3f);
        const float from = height * (0.5f + 0.08f * static_cast<float>(i));
        const vec3 out{std::cos(angle), 0.7f, std::sin(angle)};
        const std::array<vec3, 4> branch = {vec3{0, from, 0}, vec3{0, from, 0} + out * 0.4f,
                                            vec3{0, from, 0} + out * 0.8f + vec3{0, 0.1f, 0},
                                            vec3{0, from, 0} + out * 1.2f + vec3{0, 0.3f, 0}};
        shape.append(tube(branch, std::array<float, 4>{0.07f, 0.05f, 0.035f, 0.02f}, 7));
    }
    return shape;
}

/// Grass within a square of 4 m about the origin.
Shape grass(Dice& dice) {
    Shape soup;
    for (int i = 0; i < kBlades; ++i) {
        const vec3 foot{dice.between(-2, 2), 0, dice.between(-2, 2)};
        const float height = dice.between(0.14f, 0.42f), angle = 2 * kPi * dice.next();
        const vec3 across{0.014f * std::cos(angle), 0, 0.014f * std::sin(angle)};
        const vec3 lean{dice.between(-0.12f, 0.12f), 0, dice.between(-0.12f, 0.12f)};
        const vec3 tip = foot + vec3{0, height, 0} + lean;
        const vec3 middle = foot + vec3{0, 0.55f * height, 0} + lean * 0.3f;
        add_blade(soup, foot - across, foot + across, middle + across * 0.8f, tip);
    }
    return soup_to_shape(std::move(soup), 60);
}

/// Bends every vertex by the square of its height: one target along the wind, one across it.
void add_bends(Primitive& primitive) {
    for (const vec3 direction : {kWind, vec3{-kWind.z, 0, kWind.x}}) {
        MorphTarget target;
        for (const vec3 p : primitive.positions) {
            const float bend = 1.6f * p.y * p.y;
            target.positions.push_back(direction * bend + vec3{0, -0.6f * bend * p.y, 0});
        }
        primitive.targets.push_back(std::move(target));
    }
}

/// Where a thing may stand: not in the pond, nor in the camera's way.
vec3 free_place(Dice& dice, float half, float from_pond) {
    for (;;) {
        const float x = dice.between(-half, half), z = dice.between(-half, 0.6f * half);
        const bool in_view = z > 0 && std::abs(x - 0.15f * z) < 3;
        if (distance_to_pond(x, z) > kPond + from_pond && !in_view) return on_ground(x, z);
    }
}

std::vector<float> key_times() {
    std::vector<float> times;
    for (int k = 0; k <= kKeys; ++k) times.push_back(kLoop * static_cast<float>(k) / kKeys);
    return times;
}

float phase_at(int key, vec3 place) {
    return 2 * kPi * static_cast<float>(key % kKeys) / kKeys - 0.35f * dot(place, kWind);
}

void add_crowns(SceneBuilder& scene, int tree, vec3 place, std::span<const int> meshes,
                float height, Dice& dice) {
    for (int i = 0; i < kCrowns; ++i) {
        const int node = scene.add_node("crown", meshes[static_cast<size_t>(i) % meshes.size()]);
        const float angle = 2.4f * static_cast<float>(i);
        const float out = i == kCrowns - 1 ? 0 : 0.95f;
        scene.node(node).translation = {out * std::cos(angle),
                                        height * (0.74f + 0.07f * static_cast<float>(i)),
                                        out * std::sin(angle)};
        const vec4 rest = turn({0, 1, 0}, 360 * dice.next());
        scene.node(node).rotation = rest;
        scene.attach(node, tree);
        std::vector<float> turns;
        for (int k = 0; k <= kKeys; ++k) {
            const float phase = phase_at(k, place) - static_cast<float>(i);
            const vec4 q = then(rest, then(turn({0.36f, 0, -0.93f}, 4 + 5 * std::sin(phase)),
                                           turn(kWind, 3 * std::cos(phase))));
            turns.insert(turns.end(), {q.x, q.y, q.z, q.w});
        }
        scene.animate(node, Path::rotation, key_times(), std::move(turns));
    }
}

void add_trees(SceneBuilder& scene) {
    const int bark = scene.diffuse("bark", {0.16f, 0.11f, 0.075f});
    const std::array<int, kShapes> greens = {scene.diffuse("leaf", {0.09f, 0.2f, 0.05f}),
                                             scene.diffuse("light leaf", {0.17f, 0.27f, 0.06f}),
                                             scene.diffuse("autumn leaf", {0.36f, 0.19f, 0.04f})};
    constexpr float kHeight = 4.4f;  // m, of a trunk
    Dice dice(31);
    std::array<int, kShapes> trunks{}, crowns{};
    for (size_t i = 0; i < kShapes; ++i) {
        scene.material(greens[i]).double_sided = true;
        trunks[i] = scene.add_mesh("trunk " + std::to_string(i), {{trunk(kHeight, dice), bark}});
        crowns[i] = scene.add_mesh("crown " + std::to_string(i), {{crown(dice), greens[i]}});
    }
    for (int i = 0; i < kTrees; ++i) {
        const vec3 place = free_place(dice, kHalf - 2.5f, 1.4f);
        const int tree = scene.add_node("tree", trunks[static_cast<size_t>(i % kShapes)]);
        const float scale = dice.between(0.8f, 1.35f);
        scene.node(tree).translation = place;
        scene.node(tree).rotation = turn({0, 1, 0}, 360 * dice.next());
        scene.node(tree).scale = {scale, scale, scale};
        const auto kind = static_cast<size_t>(i % 7 == 3 ? 2 : i % 2);
        const std::array<int, 2> leaves = {crowns[kind], crowns[kind == 2 ? 2 : 1 - kind]};
        add_crowns(scene, tree, place, leaves, kHeight, dice);
    }
}

void add_grass(SceneBuilder& scene) {
    const int green = scene.diffuse("grass", {0.14f, 0.26f, 0.05f});
    scene.material(green).double_sided = true;
    Dice dice(47);
    std::array<int, kShapes> meshes{};
    for (size_t i = 0; i < kShapes; ++i) {
        meshes[i] = scene.add_mesh("grass " + std::to_string(i), {{grass(dice), green}});
        add_bends(scene.mesh(meshes[i]).primitives[0]);
        scene.mesh(meshes[i]).weights = {0.2f, 0};
    }
    for (int i = 0; i < kPatches; ++i) {
        // Most of it about the near shore, where it is seen best.
        const float angle = 2.4f * static_cast<float>(i);
        const float radius = kPond + 1.5f + 0.26f * static_cast<float>(i);
        const vec3 place = on_ground(kPondCenter.x + radius * std::cos(angle),
                                     kPondCenter.z + radius * std::sin(angle));
        const int node = scene.add_node("grass", meshes[static_cast<size_t>(i) % kShapes]);
        scene.node(node).translation = place - vec3{0, 0.04f, 0};
        scene.node(node).rotation = turn({0, 1, 0}, 90 * static_cast<float>(i % 4));
        std::vector<float> weights;
        for (int k = 0; k <= kKeys; ++k) {
            const float phase = phase_at(k, place);
            weights.insert(weights.end(),
                           {0.35f + 0.35f * std::sin(phase), 0.25f * std::cos(2 * phase)});
        }
        scene.animate(node, Path::weights, key_times(), std::move(weights));
    }
}

void add_land(SceneBuilder& scene) {
    const int earth = scene.diffuse("earth", {0.13f, 0.14f, 0.06f});
    const int water = scene.glossy("water", {0.015f, 0.035f, 0.04f}, 0.02f);
    const int stone = scene.glossy("stone", {0.3f, 0.29f, 0.28f}, 0.5f);
    const int sky = scene.luminous("sky", {0.5f, 0.5f, 0.5f}, vec3{0.62f, 0.8f, 1.1f} * 4500.0f);
    scene.add(
        "ground",
        sheet([](float u, float v) { return on_ground((2 * u - 1) * kHalf, (1 - 2 * v) * kHalf); },
              24, 24),
        earth);
    scene.add(
        "pond",
        cylinder({kPondCenter.x, kPondCenter.y - 0.02f, kPondCenter.z}, kPond + 0.6f, 0.02f, 48),
        water);
    Dice dice(3);
    Shape stones;
    for (int i = 0; i < 9; ++i) {
        const float angle = 0.8f * static_cast<float>(i), size = dice.between(0.15f, 0.5f);
        const vec3 place = on_ground(kPondCenter.x + (kPond + 0.25f) * std::cos(angle),
                                     kPondCenter.z + (kPond + 0.25f) * std::sin(angle));
        stones.append(rounded_box({-size, -0.7f * size, -0.8f * size},
                                  {size, 0.7f * size, 0.8f * size}, 0.55f * size, 3)
                          .turned({0.2f, 1, 0.1f}, 50 * static_cast<float>(i))
                          .moved(place));
    }
    scene.add("stones", stones, stone);
    // The sky that is seen and that the pond mirrors: behind the trees, and to the left.
    constexpr float kHigh = 26, kBack = -24;
    Shape back = quad({-34, -2, kBack}, {34, -2, kBack}, {34, kHigh, kBack}, {-34, kHigh, kBack});
    back.append(quad({-34, -2, 24}, {-34, -2, kBack}, {-34, kHigh, kBack}, {-34, kHigh, 24}));
    scene.add("sky", back, sky);
}

}  // namespace

Scene forest() {
    SceneBuilder scene("forest");
    scene.look({2.2f, 2.1f, 13.5f}, {0.2f, 1.7f, 0}, 48);
    add_land(scene);
    add_trees(scene);
    add_grass(scene);
    Light sun;
    sun.name = "sun";
    sun.kind = LightKind::directional;
    sun.intensity = vec3{1, 0.93f, 0.8f} * 45'000.0f;
    scene.add_directional(sun, 125, 38);
    return scene.take();
}

}  // namespace aglow::builtin
