// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/nodes.h"

#include "aglow/scene/gltf/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aglow::gltf {
namespace {

double norm(vec4 q) {
    return std::hypot(std::hypot(static_cast<double>(q.x), q.y),
                      std::hypot(static_cast<double>(q.z), q.w));
}

/// Rounding of 8-bit quaternions stays below.
bool is_unit(vec4 q) { return std::abs(norm(q) - 1) <= 1e-2; }

/// Unit quaternion along `q`; the identity where it has no direction.
vec4 unit_quaternion(vec4 q) {
    const double length = norm(q);
    if (!(length > 0)) return {0, 0, 0, 1};
    return {static_cast<float>(q.x / length), static_cast<float>(q.y / length),
            static_cast<float>(q.z / length), static_cast<float>(q.w / length)};
}

Status read_transform(const Json& json, Node& node, std::vector<std::string>& warnings) {
    float t[3] = {0, 0, 0}, r[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    AG_CHECK(json.numbers("translation", t));
    AG_CHECK(json.numbers("rotation", r));
    AG_CHECK(json.numbers("scale", s));
    node.translation = {t[0], t[1], t[2]};
    node.rotation = unit_quaternion({r[0], r[1], r[2], r[3]});
    if (!is_unit({r[0], r[1], r[2], r[3]}))
        warnings.push_back(json.element() + ": rotation is not a unit quaternion");
    node.scale = {s[0], s[1], s[2]};
    node.has_matrix = json.has("matrix");
    AG_CHECK(json.numbers("matrix", node.matrix.m));
    constexpr float kTolerance = 1e-5f;
    for (int column = 0; column < 4; ++column) {
        const float expected = column == 3 ? 1.0f : 0.0f;
        if (std::abs(node.matrix.at(3, column) - expected) > kTolerance)
            return json.wrong("matrix is not an affine map: its last row must be 0 0 0 1");
        node.matrix.m[static_cast<size_t>(4 * column + 3)] = expected;
    }
    if (node.has_matrix && (json.has("translation") || json.has("rotation") || json.has("scale")))
        warnings.push_back(json.element() +
                           ": has a matrix; translation, rotation and scale are "
                           "left out");
    return {};
}

Status read_references(const Json& json, size_t skin_count, size_t punctual_count,
                       const Scene& scene, Node& node) {
    AG_TRY(node.mesh, json.index("mesh", scene.meshes.size(), "mesh"));
    AG_TRY(node.camera, json.index("camera", scene.cameras.size(), "camera"));
    AG_TRY(node.skin, json.index("skin", skin_count, "skin"));
    AG_TRY(const Json light, json.extension("KHR_lights_punctual"));
    AG_TRY(node.light, light.index("light", punctual_count, "light"));
    AG_TRY(node.weights, json.number_list("weights"));
    const size_t targets =
        node.mesh < 0 ? 0 : scene.meshes[static_cast<size_t>(node.mesh)].weights.size();
    if (!node.weights.empty() && node.weights.size() != targets)
        return json.wrong(
            fmt::format("has {} weights for {} morph targets", node.weights.size(), targets));
    return {};
}

/// EXT_lights_ies: a light of the node's own. It takes the place of a punctual one, which writers
/// add for programs that do not know the extension.
Status read_luminaire_of(const Json& json, const LightProfiles& profiles, Scene& scene,
                         Node& node) {
    AG_TRY(std::optional<Light> luminaire, read_luminaire(json, profiles));
    if (!luminaire) return {};
    node.light = static_cast<int>(scene.lights.size());
    scene.lights.push_back(std::move(*luminaire));
    return {};
}

/// EXT_mesh_gpu_instancing: T * R * S of every instance.
Status read_instances(const Json& json, Accessors& accessors, Node& node,
                      std::vector<std::string>& warnings) {
    AG_TRY(const Json extension, json.extension("EXT_mesh_gpu_instancing"));
    if (!extension.exists() || node.mesh < 0) return {};
    AG_TRY(const Json list, extension.object("attributes"));
    AttributeReader attributes(list, accessors, std::nullopt);
    AG_TRY(const std::vector<float> t, attributes.read("TRANSLATION", {3}));
    AG_TRY(const std::vector<float> r, attributes.read("ROTATION", {4}));
    AG_TRY(const std::vector<float> s, attributes.read("SCALE", {3}));
    const size_t count = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
    if (count == 0) return json.wrong("EXT_mesh_gpu_instancing places no instance");
    AG_CHECK(attributes.charge(16 * count));
    node.instances.reserve(count);
    bool all_unit = true;
    for (size_t i = 0; i < count; ++i) {
        vec3 translation{0, 0, 0}, scale{1, 1, 1};
        vec4 rotation{0, 0, 0, 1};
        if (!t.empty()) translation = {t[3 * i], t[3 * i + 1], t[3 * i + 2]};
        if (!s.empty()) scale = {s[3 * i], s[3 * i + 1], s[3 * i + 2]};
        if (!r.empty()) rotation = {r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]};
        all_unit = all_unit && is_unit(rotation);
        node.instances.push_back(compose(translation, unit_quaternion(rotation), scale));
    }
    if (!all_unit)
        warnings.push_back(json.element() + ": an instance's rotation is not a unit quaternion");
    return {};
}

/// Sets parents and sees to it that the nodes form trees.
Status link(const std::vector<Json>& list, std::vector<Node>& nodes) {
    for (size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            int& parent = nodes[static_cast<size_t>(child)].parent;
            if (parent >= 0)
                return list[static_cast<size_t>(child)].wrong(
                    fmt::format("is a child of node {} and of node {}", parent, i));
            parent = static_cast<int>(i);
        }
    // With one parent each, the nodes that no root reaches are those on cycles and below them.
    std::vector<int> open;
    for (size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent < 0) open.push_back(static_cast<int>(i));
    std::vector<bool> reached(nodes.size(), false);
    while (!open.empty()) {
        const auto i = static_cast<size_t>(open.back());
        open.pop_back();
        reached[i] = true;
        open.insert(open.end(), nodes[i].children.begin(), nodes[i].children.end());
    }
    const auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end())
        return list[static_cast<size_t>(lost - reached.begin())].wrong(
            "lies on or below a cycle of nodes");
    return {};
}

/// Sets in_scene of node `top` and all below it.
void set_in_scene(std::vector<Node>& nodes, int top, bool in_scene) {
    std::vector<int> open{top};
    while (!open.empty()) {
        Node& node = nodes[static_cast<size_t>(open.back())];
        open.pop_back();
        if (node.in_scene == in_scene) continue;  // its children were set with it
        node.in_scene = in_scene;
        open.insert(open.end(), node.children.begin(), node.children.end());
    }
}

Status activate(const Json& root, std::vector<Node>& nodes, std::vector<std::string>& warnings) {
    AG_TRY(const std::vector<Json> scenes, elements(root, "scenes", "scene"));
    AG_TRY(int active, root.index("scene", scenes.size(), "scene"));
    std::vector<std::vector<int>> roots;
    for (const Json& json : scenes) {
        AG_TRY(std::vector<int> list, json.indices("nodes", nodes.size(), "node"));
        roots.push_back(std::move(list));
    }
    if (scenes.empty()) return {};
    active = std::max(active, 0);
    for (Node& node : nodes) node.in_scene = false;
    for (const int i : roots[static_cast<size_t>(active)]) {
        if (nodes[static_cast<size_t>(i)].parent >= 0)
            warnings.push_back(fmt::format("scene {}: node {} is not a root node", active, i));
        set_in_scene(nodes, i, true);
    }
    return {};
}

/// MSFT_lod: the node itself is the finest level; the coarser ones it names are not shown.
Status hide_coarse_levels(const std::vector<Json>& list, std::vector<Node>& nodes) {
    for (const Json& json : list) {
        AG_TRY(const Json lod, json.extension("MSFT_lod"));
        AG_TRY(const std::vector<int> levels, lod.indices("ids", nodes.size(), "node"));
        for (const int level : levels) {
            if (&json == &list[static_cast<size_t>(level)])
                return json.wrong("is a coarser level of detail of itself");
            set_in_scene(nodes, level, false);
        }
    }
    return {};
}

}  // namespace

Status read_nodes(const Json& root, Accessors& accessors, size_t skin_count,
                  const LightProfiles& profiles, Scene& scene) {
    AG_TRY(const std::vector<Json> list, elements(root, "nodes", "node"));
    const size_t punctual_count = scene.lights.size();
    for (const Json& json : list) {
        Node node;
        AG_TRY(node.name, json.text("name", ""));
        AG_CHECK(read_transform(json, node, scene.warnings));
        AG_CHECK(read_references(json, skin_count, punctual_count, scene, node));
        AG_CHECK(read_luminaire_of(json, profiles, scene, node));
        AG_CHECK(read_instances(json, accessors, node, scene.warnings));
        AG_TRY(node.children, json.indices("children", list.size(), "child node"));
        scene.nodes.push_back(std::move(node));
    }
    AG_CHECK(link(list, scene.nodes));
    AG_CHECK(activate(root, scene.nodes, scene.warnings));
    return hide_coarse_levels(list, scene.nodes);
}

}  // namespace aglow::gltf
