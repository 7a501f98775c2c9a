// SPDX-License-Identifier: Apache-2.0
// A mannequin that walks in place: one skinned mesh over seventeen joints. Facing +Z.
#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr float kCycle = 1.2f;  // seconds for two steps
constexpr int kKeys = 24;       // of a cycle
constexpr size_t kInfluences = 4;

enum Joint : uint32_t {
    hips,
    spine,
    chest,
    neck,
    head,
    upper_arm_l,
    forearm_l,
    hand_l,
    upper_arm_r,
    forearm_r,
    hand_r,
    thigh_l,
    shin_l,
    foot_l,
    thigh_r,
    shin_r,
    foot_r,
    joint_count
};

struct Bone {
    const char* name;
    int parent;
    vec3 from, to;  ///< m, in the rest pose
};

constexpr std::array<Bone, joint_count> kBones = {{
    {"hips", -1, {0, 0.95f, 0}, {0, 1.06f, 0}},
    {"spine", hips, {0, 1.06f, 0}, {0, 1.24f, 0}},
    {"chest", spine, {0, 1.24f, 0}, {0, 1.46f, 0}},
    {"neck", chest, {0, 1.46f, 0}, {0, 1.55f, 0}},
    {"head", neck, {0, 1.55f, 0}, {0, 1.75f, 0}},
    {"upper arm left", chest, {0.2f, 1.41f, 0}, {0.25f, 1.13f, 0}},
    {"forearm left", upper_arm_l, {0.25f, 1.13f, 0}, {0.28f, 0.88f, 0}},
    {"hand left", forearm_l, {0.28f, 0.88f, 0}, {0.285f, 0.76f, 0}},
    {"upper arm right", chest, {-0.2f, 1.41f, 0}, {-0.25f, 1.13f, 0}},
    {"forearm right", upper_arm_r, {-0.25f, 1.13f, 0}, {-0.28f, 0.88f, 0}},
    {"hand right", forearm_r, {-0.28f, 0.88f, 0}, {-0.285f, 0.76f, 0}},
    {"thigh left", hips, {0.1f, 0.92f, 0}, {0.1f, 0.5f, 0}},
    {"shin left", thigh_l, {0.1f, 0.5f, 0}, {0.1f, 0.1f, 0}},
    {"foot left", shin_l, {0.1f, 0.1f, 0}, {0.1f, 0.03f, 0.14f}},
    {"thigh right", hips, {-0.1f, 0.92f, 0}, {-0.1f, 0.5f, 0}},
    {"shin right", thigh_r, {-0.1f, 0.5f, 0}, {-0.1f, 0.1f, 0}},
    {"foot right", shin_r, {-0.1f, 0.1f, 0}, {-0.1f, 0.03f, 0.14f}},
}};

/// A shape and the joints that may move it.
struct Limb {
    Shape shape;
    std::vector<uint32_t> joints;
};

/// Tube through points at equal steps of t with round ends; `radius` at t in 0..1.
Shape round_tube(std::span<const vec3> points, const std::function<float(float)>& radius,
                 int slices, int steps) {
    std::vector<vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= steps; ++i) {
        // Cosine steps: close rings at both ends, where the tube closes.
        const float t =
            0.5f - 0.5f * std::cos(kPi * static_cast<float>(i) / static_cast<float>(steps));
        const float along = t * static_cast<float>(points.size() - 1);
        const size_t k = std::min(static_cast<size_t>(along), points.size() - 2);
        const float part = along - static_cast<float>(k);
        path.push_back(points[k] * (1 - part) + points[k + 1] * part);
        const float end = std::min(1.0f, std::min(t, 1 - t) / 0.1f);
        radii.push_back(std::max(0.004f, radius(t) * std::sqrt(end * (2 - end))));
    }
    return tube(path, radii, slices);
}

/// Value at t of a curve through equally spaced points, smooth between them.
float curve(std::span<const float> points, float t) {
    const float along = t * static_cast<float>(points.size() - 1);
    const size_t k = std::min(static_cast<size_t>(along), points.size() - 2);
    const float x = along - static_cast<float>(k);
    return shared::mix(points[k], points[k + 1], x * x * (3 - 2 * x));
}

Shape leg(float side) {
    const std::array<vec3, 3> path = {
        vec3{0.095f * side, 0.98f, 0}, {0.1f * side, 0.5f, 0.012f}, {0.1f * side, 0.07f, -0.01f}};
    constexpr std::array<float, 9> kRadii = {0.09f,  0.1f,   0.095f, 0.08f, 0.062f,
                                             0.066f, 0.062f, 0.05f,  0.045f};
    return round_tube(
        path, [&](float t) { return curve(kRadii, t); }, 28, 40);
}

Shape arm(float side) {
    const std::array<vec3, 3> path = {
        vec3{0.17f * side, 1.45f, 0}, {0.25f * side, 1.13f, 0}, {0.282f * side, 0.85f, 0}};
    constexpr std::array<float, 7> kRadii = {0.07f, 0.062f, 0.055f, 0.045f, 0.047f, 0.04f, 0.034f};
    return round_tube(
        path, [&](float t) { return curve(kRadii, t); }, 26, 34);
}

Shape torso() {
    const std::array<vec3, 2> path = {vec3{0, 0.86f, 0}, {0, 1.5f, 0}};
    constexpr std::array<float, 8> kRadii = {0.15f,  0.175f, 0.15f, 0.14f,
                                             0.165f, 0.19f,  0.19f, 0.1f};
    return round_tube(
               path, [&](float t) { return curve(kRadii, t); }, 44, 38)
        .scaled({1, 1, 0.66f});
}

Shape foot(float side) {
    return sphere({0, 0, 0}, 1, 20, 14)
        .scaled({0.052f, 0.048f, 0.13f})
        .moved({0.1f * side, 0.048f, 0.06f});
}

Shape hand(float side) {
    return sphere({0, 0, 0}, 1, 18, 14)
        .scaled({0.03f, 0.075f, 0.045f})
        .moved({0.285f * side, 0.79f, 0});
}

float distance_to_bone(vec3 p, const Bone& bone) {
    const vec3 along = bone.to - bone.from;
    const float t = std::clamp(dot(p - bone.from, along) / dot(along, along), 0.0f, 1.0f);
    return length(p - bone.from - along * t);
}

/// Weights of a vertex: the nearer a bone, the more of it; at most four, their sum is 1.
void add_influences(Primitive& primitive, vec3 p, std::span<const uint32_t> candidates) {
    std::array<float, kInfluences> weights{};
    std::array<uint32_t, kInfluences> joints{};
    float sum = 0;
    for (size_t i = 0; i < candidates.size(); ++i) {
        const float d = distance_to_bone(p, kBones[candidates[i]]) + 0.01f;
        joints[i] = candidates[i];
        weights[i] = 1 / (d * d * d * d * d);
        sum += weights[i];
    }
    for (float& w : weights) w /= sum;
    primitive.joints.insert(primitive.joints.end(), joints.begin(), joints.end());
    primitive.weights.insert(primitive.weights.end(), weights.begin(), weights.end());
}

void bind_skin(Primitive& primitive, std::span<const Limb> limbs) {
    primitive.influences = kInfluences;
    for (const Limb& limb : limbs)
        for (const vec3 p : limb.shape.positions) add_influences(primitive, p, limb.joints);
}

Shape joined(std::span<const Limb> limbs) {
    Shape all;
    for (const Limb& limb : limbs) all.append(limb.shape);
    return all;
}

int add_body(SceneBuilder& scene) {
    const int suit = scene.glossy("suit", {0.05f, 0.2f, 0.42f}, 0.4f);
    const int sleeves = scene.glossy("sleeves", {0.72f, 0.7f, 0.64f}, 0.45f);
    const int rubber = scene.diffuse("rubber", {0.06f, 0.06f, 0.065f});
    const int chrome = scene.metal("chrome", {0.75f, 0.75f, 0.77f}, 0.1f);
    const std::vector<Limb> body = {{torso(), {hips, spine, chest, neck}},
                                    {leg(1), {hips, thigh_l, shin_l, foot_l}},
                                    {leg(-1), {hips, thigh_r, shin_r, foot_r}}};
    const std::vector<Limb> arms = {{arm(1), {chest, upper_arm_l, forearm_l, hand_l}},
                                    {arm(-1), {chest, upper_arm_r, forearm_r, hand_r}}};
    const std::vector<Limb> ends = {{foot(1), {shin_l, foot_l}},
                                    {foot(-1), {shin_r, foot_r}},
                                    {hand(1), {forearm_l, hand_l}},
                                    {hand(-1), {forearm_r, hand_r}}};
    const std::vector<Limb> top = {
        {sphere({0, 0, 0}, 1, 40, 30).scaled({0.1f, 0.135f, 0.12f}).moved({0, 1.66f, 0.01f}),
         {head}},
        {cylinder({0, 1.44f, 0}, 0.05f, 0.12f, 28), {chest, neck, head}}};
    const int node = scene.add("mannequin", {{joined(body), suit},
                                             {joined(arms), sleeves},
                                             {joined(ends), rubber},
                                             {joined(top), chrome}});
    std::vector<Primitive>& primitives = scene.mesh(scene.node(node).mesh).primitives;
    bind_skin(primitives[0], body);
    bind_skin(primitives[1], arms);
    bind_skin(primitives[2], ends);
    bind_skin(primitives[3], top);
    return node;
}

/// Nodes of the joints; the skin's joint j is the node of kBones[j].
std::array<int, joint_count> add_skeleton(SceneBuilder& scene, int body) {
    std::array<int, joint_count> nodes{};
    Skin skin;
    for (size_t j = 0; j < joint_count; ++j) {
        const Bone& bone = kBones[j];
        nodes[j] = scene.add_node(bone.name);
        vec3 offset = bone.from;
        if (bone.parent >= 0) {
            const auto parent = static_cast<size_t>(bone.parent);
            offset = offset - kBones[parent].from;
            scene.attach(nodes[j], nodes[parent]);
        }
        scene.node(nodes[j]).translation = offset;
        skin.joints.push_back(nodes[j]);
        skin.inverse_bind.push_back(translation(-bone.from));
    }
    scene.node(body).skin = scene.add_skin(std::move(skin));
    return nodes;
}

/// Angles about +X of a leg, in degrees: positive turns what hangs down backward.
struct LegPose {
    float thigh, knee, ankle;

    explicit LegPose(float phase) {
        const float swing = std::max(0.0f, std::cos(phase + 0.35f));
        thigh = -4 - 24 * std::sin(phase);
        knee = 7 + 52 * swing * std::sqrt(swing);
        ankle = -(thigh + knee) * (1 - 0.45f * swing);
    }
    /// How far the sole is below the hips' joint.
    float reach() const {
        const auto down = [](float degrees) { return std::cos(degrees * kPi / 180); };
        return 0.03f + 0.42f * down(thigh) + 0.4f * down(thigh + knee) + 0.1f;
    }
};

struct Keys {
    std::vector<float> values;
    void add(vec4 q) { values.insert(values.end(), {q.x, q.y, q.z, q.w}); }
    void add(vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); }
};

void animate_walk(SceneBuilder& scene, const std::array<int, joint_count>& nodes) {
    std::vector<float> times;
    std::array<Keys, joint_count> turns;
    Keys lift;
    for (int k = 0; k <= kKeys; ++k) {
        const float t = static_cast<float>(k % kKeys) / kKeys, phase = 2 * kPi * t;
        times.push_back(kCycle * static_cast<float>(k) / kKeys);
        const auto x = [](float degrees) { return turn({1, 0, 0}, degrees); };
        const auto y = [](float degrees) { return turn({0, 1, 0}, degrees); };
        const LegPose left(phase), right(phase + kPi);
        const float swing = std::sin(phase);
        turns[thigh_l].add(x(left.thigh)), turns[thigh_r].add(x(right.thigh));
        turns[shin_l].add(x(left.knee)), turns[shin_r].add(x(right.knee));
        turns[foot_l].add(x(left.ankle)), turns[foot_r].add(x(right.ankle));
        turns[upper_arm_l].add(x(4 + 26 * swing)), turns[upper_arm_r].add(x(4 - 26 * swing));
        turns[forearm_l].add(x(-26 + 12 * swing)), turns[forearm_r].add(x(-26 - 12 * swing));
        turns[hips].add(y(-6 * swing)), turns[chest].add(y(9 * swing));
        turns[spine].add(x(3 + std::cos(2 * phase))), turns[head].add(y(-3 * swing));
        lift.add(vec3{0.012f * std::cos(phase), std::max(left.reach(), right.reach()), 0});
    }
    for (size_t j = 0; j < joint_count; ++j)
        if (!turns[j].values.empty())
            scene.animate(nodes[j], Path::rotation, times, turns[j].values);
    scene.animate(nodes[hips], Path::translation, times, lift.values);
}

}  // namespace

Scene walker() {
    SceneBuilder scene("walker");
    const int floor = scene.textured(
        painted("tiles", 256, 256,
                [](float u, float v) {
                    const bool dark = (static_cast<int>(8 * u) + static_cast<int>(8 * v)) % 2;
                    return dark ? vec3{0.16f, 0.17f, 0.2f} : vec3{0.55f, 0.54f, 0.52f};
                }),
        {1, 1, 1});
    scene.material(floor).roughness = 0.15f;
    add_studio(scene,
               {.half = 2.2f,
                .height = 3,
                .spot = vec3{8000, 7600, 7000},
                .spot_position = {1.9f, 2.7f, 1.7f},
                .spot_target = {0, 0.9f, 0}},
               floor);
    scene.look({1.7f, 1.45f, 2.6f}, {0, 0.86f, 0}, 40);
    const int body = add_body(scene);
    animate_walk(scene, add_skeleton(scene, body));
    return scene.take();
}

}  // namespace aglow::builtin
