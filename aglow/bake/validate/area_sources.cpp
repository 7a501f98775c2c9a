// SPDX-License-Identifier: Apache-2.0
// Emissive rectangles of 1000 cd/m^2 in black surroundings: E = pi L F.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

#include <cmath>

namespace aglow::validation {
namespace {

constexpr double kLuminance = 1000;  // cd/m^2
constexpr double kExitance = kPi * kLuminance;
constexpr const char* kPolygon = "pi L F, polygon formula";
constexpr const char* kCorner = "pi L F, corner formula";

int add_emitter(Scene& scene, vec3 corner, vec3 u, vec3 v) {
    return add_rectangle(scene, add_grey(scene, 0, static_cast<float>(kLuminance)), corner, u, v);
}

Point point(vec3 p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// A sensor at the origin below, or beside, one emitter.
Experiment one_sensor(std::string name, vec3 normal, vec3 corner, vec3 u, vec3 v, double factor,
                      const char* source) {
    Experiment e{.group = "area source", .name = std::move(name), .scene = {}};
    add_emitter(e.scene, corner, u, v);
    e.sensors = {sensor({0, 0, 0}, normal)};
    e.checks = {total_at(0, "E at the sensor", kExitance * factor, source)};
    return e;
}

Experiment by_polygon(std::string name, vec3 normal, vec3 corner, vec3 u, vec3 v) {
    const double factor =
        rectangle_factor({0, 0, 0}, unit(point(normal)), point(corner), point(u), point(v));
    return one_sensor(std::move(name), normal, corner, u, v, factor, kPolygon);
}

Experiment occluded() {
    const vec3 up{0, 1, 0};
    Experiment e =
        by_polygon("partly hidden by a plate half-way", up, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});
    add_rectangle(e.scene, add_grey(e.scene, 0), {0.1f, 1, -0.3f}, {1, 0, 0}, {0, 0, 0.9f});
    // Seen from the origin the plate hides what lies at twice its coordinates, as far as the
    // emitter reaches.
    const double hidden =
        rectangle_factor({0, 0, 0}, {0, 1, 0}, {0.2, 2, -0.6}, {0.8, 0, 0}, {0, 0, 1.6});
    e.checks[0].expected -= kExitance * hidden;
    e.checks[0].source = "pi L (F - F hidden), polygon formula";
    return e;
}

Experiment mirrored_node() {
    Experiment e{
        .group = "area source", .name = "placed by a mirrored, stretched node", .scene = {}};
    const int node = add_emitter(e.scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    e.scene.nodes[static_cast<size_t>(node)].translation = {0, 1.5f, 0};
    e.scene.nodes[static_cast<size_t>(node)].scale = {-2, 1, 3};
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E at the sensor", kExitance * corner_parallel(2, 3, 1.5), kCorner)};
    return e;
}

Experiment double_sided() {
    Experiment e{.group = "area source", .name = "double-sided, from behind", .scene = {}};
    const auto bright = static_cast<float>(kLuminance);
    const int material = add_material(e.scene, {0, 0, 0}, {bright, bright, bright}, Sides::two);
    add_rectangle(e.scene, material, {0, 1.5f, 0}, {0, 0, 3}, {2, 0, 0});  // front upwards
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E at the sensor", kExitance * corner_parallel(2, 3, 1.5), kCorner)};
    return e;
}

/// The half of the emitter over which the texture is white.
Experiment textured() {
    Experiment e{.group = "area source", .name = "emissive texture, half of it black", .scene = {}};
    const int node = add_emitter(e.scene, {0, 1.5f, 0}, {4, 0, 0}, {0, 0, 3});
    Scene& scene = e.scene;
    scene.images.push_back(
        {.name = "half", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 0, 0, 0, 255}});
    scene.textures.push_back({.image = 0,
                              .wrap_s = Wrap::clamp_to_edge,
                              .wrap_t = Wrap::clamp_to_edge,
                              .filter = Filter::nearest});
    scene.materials[0].emissive_texture.texture = 0;
    const int mesh = scene.nodes[static_cast<size_t>(node)].mesh;
    scene.meshes[static_cast<size_t>(mesh)].primitives[0].texcoords = {
        {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E at the sensor", kExitance * corner_parallel(2, 3, 1.5), kCorner)};
    return e;
}

Experiment square_pair(std::string name, double factor, const char* source, vec3 corner, vec3 u,
                       vec3 v) {
    Experiment e{.group = "square to square",
                 .name = std::move(name),
                 .scene = {},
                 .bakes = true,
                 .resolution = 48};
    const int receiver =
        add_rectangle(e.scene, add_grey(e.scene, 0), {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    add_emitter(e.scene, corner, u, v);
    e.checks = {{.quantity = "mean E of the other square",
                 .source = source,
                 .expected = kExitance * factor,
                 .read = [receiver](const Evidence& evidence) {
                     return mean_over_node(*evidence.baked, receiver, Share::total);
                 }}};
    return e;
}

}  // namespace

std::vector<Experiment> area_sources() {
    const vec3 up{0, 1, 0}, tilted{0.5f, std::sqrt(0.75f), 0}, steep{std::sqrt(0.75f), 0.5f, 0};
    return {
        one_sensor("parallel, over its corner", up, {0, 1.5f, 0}, {2, 0, 0}, {0, 0, 3},
                   corner_parallel(2, 3, 1.5), kCorner),
        one_sensor("parallel, very near", up, {-2, 0.1f, -2}, {4, 0, 0}, {0, 0, 4},
                   4 * corner_parallel(2, 2, 0.1), kCorner),
        by_polygon("parallel, far", up, {-0.5f, 20, -0.5f}, {1, 0, 0}, {0, 0, 1}),
        one_sensor("perpendicular", up, {1.5f, 0, 0}, {0, 0, 2}, {0, 3, 0},
                   corner_perpendicular(2, 3, 1.5), kCorner),
        by_polygon("tilted sensor", tilted, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}),
        by_polygon("partly below the horizon", steep, {-2, 1, -1}, {4, 0, 0}, {0, 0, 2}),
        occluded(),
        mirrored_node(),
        double_sided(),
        textured(),
        square_pair("facing at distance 1", facing_rectangles(1, 1, 1), "pi L F, F = 0.199825",
                    {0, 1, 0}, {1, 0, 0}, {0, 0, 1}),
        square_pair("sharing an edge at 90 degrees", adjoining_rectangles(1, 1, 1),
                    "pi L F, F = 0.200044", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}),
    };
}

}  // namespace aglow::validation
