// SPDX-License-Identifier: Apache-2.0
// Nodes, and the cameras and lights that they place.
#include "aglow/scene/glb/builder.h"
#include "aglow/scene/photometry.h"

#include <algorithm>

namespace aglow::glb {
namespace {

constexpr float kOrthographicDepth = 1000;  // m; glTF asks for a far plane, the scene has none

float brightest(vec3 intensity) { return std::max({intensity.x, intensity.y, intensity.z}); }

/// The node's member that names its light: punctual ones are numbered without luminaires, whose
/// factors stand in the node.
void put_light(Builder& glb, const Scene& scene, const Node& node, Json& out) {
    const Light& light = scene.lights[static_cast<size_t>(node.light)];
    const bool luminaire = light.kind == LightKind::photometric;
    const auto number = std::count_if(
        scene.lights.begin(), scene.lights.begin() + node.light,
        [&](const Light& other) { return (other.kind == LightKind::photometric) == luminaire; });
    Json& extension = glb.use(out, luminaire ? "EXT_lights_ies" : "KHR_lights_punctual");
    extension["light"] = number;
    if (!luminaire) return;
    const float multiplier = brightest(light.intensity);
    extension["multiplier"] = multiplier;
    if (multiplier > 0) extension["color"] = to_json(light.intensity / multiplier);
}

Json json_of(Builder& glb, const Scene& scene, const Node& node) {
    Json out = Json::object();
    put_name(out, node.name);
    if (!node.children.empty()) out["children"] = node.children;
    if (node.has_matrix && node.matrix != mat4{}) out["matrix"] = node.matrix.m;
    if (!node.has_matrix) {
        const Node rest;
        if (node.translation != rest.translation) out["translation"] = to_json(node.translation);
        if (node.rotation != rest.rotation) out["rotation"] = to_json(node.rotation);
        if (node.scale != rest.scale) out["scale"] = to_json(node.scale);
    }
    if (node.mesh >= 0) out["mesh"] = node.mesh;
    if (node.skin >= 0) out["skin"] = node.skin;
    if (!node.weights.empty()) out["weights"] = node.weights;
    if (node.camera >= 0) out["camera"] = node.camera;
    if (node.light >= 0) put_light(glb, scene, node, out);
    return out;
}

Json json_of(const Camera& camera) {
    Json out = Json::object();
    put_name(out, camera.name);
    if (camera.perspective) {
        out["type"] = "perspective";
        out["perspective"] = {{"yfov", camera.y_fov}, {"znear", camera.z_near}};
        if (camera.aspect > 0) out["perspective"]["aspectRatio"] = camera.aspect;
    } else {
        out["type"] = "orthographic";
        out["orthographic"] = {{"xmag", camera.x_mag},
                               {"ymag", camera.y_mag},
                               {"znear", camera.z_near},
                               {"zfar", camera.z_near + kOrthographicDepth}};
    }
    return out;
}

Json luminaire_of(Builder& glb, const Light& light) {
    const std::string file = to_lm63(*light.photometry);
    Json out = {{"bufferView", glb.add_view(file.data(), file.size())},
                {"mimeType", "application/x-ies-lm-63"}};
    put_name(out, light.photometry->name);
    return out;
}

Json punctual_of(const Light& light) {
    constexpr const char* kKinds[] = {"point", "spot", "directional"};
    const float intensity = brightest(light.intensity);
    Json out = Json::object();
    put_name(out, light.name);
    out["type"] = kKinds[static_cast<size_t>(light.kind)];
    out["color"] = to_json(intensity > 0 ? light.intensity / intensity : vec3{1, 1, 1});
    out["intensity"] = intensity;
    if (light.range < kInfinity && light.range > 0) out["range"] = light.range;
    if (light.kind == LightKind::spot)
        out["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    return out;
}

}  // namespace

void add_nodes(Builder& glb, const Scene& scene) {
    Json roots = Json::array();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        glb.json["nodes"].push_back(json_of(glb, scene, node));
        if (node.parent < 0 && node.in_scene) roots.push_back(i);
    }
    glb.json["scene"] = 0;
    Json out = Json::object();
    put_name(out, scene.name);
    if (!roots.empty()) out["nodes"] = roots;
    glb.json["scenes"] = Json::array({out});
}

void add_cameras(Builder& glb, const Scene& scene) {
    for (const Camera& camera : scene.cameras) glb.json["cameras"].push_back(json_of(camera));
}

void add_lights(Builder& glb, const Scene& scene) {
    for (const Light& light : scene.lights) {
        const bool luminaire = light.kind == LightKind::photometric;
        Json out = luminaire ? luminaire_of(glb, light) : punctual_of(light);
        glb.use(glb.json, luminaire ? "EXT_lights_ies" : "KHR_lights_punctual")["lights"].push_back(
            std::move(out));
    }
}

}  // namespace aglow::glb
