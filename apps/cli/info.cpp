// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/scene.h"
#include "command.h"
#include "devices.h"
#include "report.h"
#include "scene_options.h"

#include <algorithm>
#include <array>

namespace aglow::cli {
namespace {

struct Options {
    std::filesystem::path input;
    SceneOptions scene;
};

Table table(Options& o) {
    Table rows = {{"IN", file(&o.input), "", "scene; without it: the devices"}};
    rows += scene_table(o.scene);
    return rows;
}

Json triple(vec3 v) { return {v.x, v.y, v.z}; }

size_t emissive_triangles(const Scene& scene, const Surfaces& surfaces) {
    size_t count = 0;
    for (const SurfacePart& part : surfaces.parts) {
        if (part.material < 0) continue;
        const Material& material = scene.materials[static_cast<size_t>(part.material)];
        if (!material.unlit && luminance(material.emission) > 0) count += part.triangle_count;
    }
    return count;
}

Json light_counts(const Scene& scene) {
    constexpr std::array<const char*, 4> kNames = {"point", "spot", "directional", "photometric"};
    Json counts = {{"point", 0}, {"spot", 0}, {"directional", 0}, {"photometric", 0}};
    for (const Node& node : scene.nodes) {
        if (node.light < 0 || !node.in_scene) continue;
        const LightKind kind = scene.lights[static_cast<size_t>(node.light)].kind;
        Json& count = counts[kNames[static_cast<size_t>(kind)]];
        count = count.get<int>() + 1;
    }
    return counts;
}

Json statistics(const Options& options, const Scene& scene) {
    const Surfaces surfaces = pose(scene, options.scene.pose_time());
    Box box;
    for (const vec3 p : surfaces.positions) box.add(p);
    double surface = 0;
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t)
        surface += static_cast<double>(area(surfaces, t));
    Json report = {{"scene", options.input.string()},
                   {"triangles", surfaces.triangles.size()},
                   {"vertices", surfaces.positions.size()},
                   {"surface_area", surface},
                   {"meshes", scene.meshes.size()},
                   {"nodes", scene.nodes.size()},
                   {"parts", surfaces.parts.size()},
                   {"materials", scene.materials.size()},
                   {"textures", scene.textures.size()},
                   {"images", scene.images.size()},
                   {"emissive_triangles", emissive_triangles(scene, surfaces)},
                   {"lights", light_counts(scene)},
                   {"sky", scene.sky.has_value()}};
    if (!box.empty()) report["bounds"] = {{"low", triple(box.lo)}, {"high", triple(box.hi)}};
    Json cameras = Json::array();
    for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
    report["cameras"] = cameras;
    report["skins"] = scene.skins.size();
    Json animations = Json::array();
    for (const Animation& animation : scene.animations) animations.push_back(animation.name);
    report["animations"] = animations;
    report["warnings"] = scene.warnings;
    return report;
}

Result<int> run(const Options& options, Console& console) {
    if (options.input.empty()) {
        print_report(console, {{"version", AGLOW_VERSION},
                               {"devices", device_list(console.options().threads)}});
        return kExitDone;
    }
    AG_TRY(const Scene scene, prepare_scene(options.input, options.scene, console));
    print_report(console, statistics(options, scene));
    return kExitDone;
}

}  // namespace

Command info_command() {
    return command("info", "[IN] [options]", "tells what a scene holds; without IN: the devices",
                   table, run);
}

}  // namespace aglow::cli
