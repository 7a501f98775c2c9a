// SPDX-License-Identifier: Apache-2.0
// Where no light can arrive, exactly none may: shadows, backs of emitters, closed boxes.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

#include <algorithm>

namespace aglow::validation {
namespace {

/// Brightest of all sensors must be 0; `reference` is what one of them would get in the open.
Check dark_sensors(std::string quantity, double reference) {
    return {.quantity = std::move(quantity),
            .source = "no way for light",
            .expected = 0,
            .read =
                [](const Evidence& e) {
                    double most = 0;
                    for (const Irradiance& value : e.sensors)
                        most = std::max(most, static_cast<double>(luminance(value.total())));
                    return most;
                },
            .reference = reference};
}

Experiment behind_a_plate(std::string name, bool front_to_the_light) {
    Experiment e{.group = "darkness", .name = std::move(name), .scene = {}};
    const int grey = add_grey(e.scene, 0.5f);
    const vec3 x{2, 0, 0}, z{0, 0, 2};
    add_rectangle(e.scene, grey, {-1, 1, -1}, front_to_the_light ? z : x,
                  front_to_the_light ? x : z);
    add_point_light(e.scene, {0, 2, 0}, static_cast<float>(4 * kPi * 100));
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0.3f, 0.5f, -0.2f}, {0, 1, 0}),
                 sensor({0.3f, 0.999f, -0.2f}, {0, 1, 0})};
    e.checks = {dark_sensors("E in the shadow", 25)};
    return e;
}

Experiment behind_an_emitter() {
    Experiment e{.group = "darkness", .name = "behind a one-sided emitter", .scene = {}};
    add_rectangle(e.scene, add_grey(e.scene, 0.5f, 1000), {-1, 1, -1}, {0, 0, 2}, {2, 0, 0});
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0.9f, 0.99f, 0.9f}, {0, 1, 0})};
    e.checks = {dark_sensors("E at the sensors", kPi * 1000 * 4 * corner_parallel(1, 1, 1))};
    return e;
}

/// A convex body cannot light itself: neither over an edge nor along its own flat faces.
Experiment on_a_convex_emitter() {
    Experiment e{.group = "darkness", .name = "on a convex emitter", .scene = {}, .bakes = true};
    add_box(e.scene, add_grey(e.scene, 0.5f, 1000), {0.3f, 0.2f, 0.1f}, {1.3f, 0.7f, 0.9f},
            Facing::outwards);
    e.checks = {{.quantity = "largest E of a texel",
                 .source = "no way for light",
                 .expected = 0,
                 .read = [](const Evidence& found) { return max_over_node(*found.baked, -1); },
                 .reference = kPi * 1000}};
    return e;
}

Experiment beyond_the_cone() {
    Experiment e{.group = "darkness", .name = "outside the cone of a spot", .scene = {}};
    add_rectangle(e.scene, add_grey(e.scene, 0), {-1, -1, -1}, {0, 0, 2}, {2, 0, 0});
    add_light(e.scene,
              {.name = "lamp",
               .kind = LightKind::spot,
               .intensity = {1000, 1000, 1000},
               .inner_cone = 0.3f,
               .outer_cone = 0.6f},
              {0, 2, 0}, {0, -1, 0});
    e.sensors = {sensor({1.5f, 0, 0}, {0, 1, 0}), sensor({0, 4, 0}, {0, -1, 0})};
    e.checks = {dark_sensors("E at the sensors", 250)};
    return e;
}

/// All that can shine, round a box of 2 m at `at`: lamps close to its walls, edges and corners, a
/// bright sky, the sun.
void shine_from_outside(Scene& scene, vec3 at) {
    const float lumen = 1000;
    for (vec3 p : {vec3{1.2f, 0, 0}, vec3{0, -1.2f, 0.1f}, vec3{1.1f, 1.1f, 1.1f},
                   vec3{-1.1f, 0.2f, -1.1f}, vec3{0.3f, 3, 0.2f}})
        add_point_light(scene, at + p, lumen);
    const vec3 bright{10000, 10000, 10000};
    add_rectangle(scene, add_material(scene, {0.5f, 0.5f, 0.5f}, bright), at + vec3{-3, 1.5f, -3},
                  {6, 0, 0}, {0, 0, 6});
    scene.sky = Sky{.luminance = {1000, 1000, 1000}, .image = nullptr};
    add_sun(scene, 200, 40, 80000);
}

/// A closed box, bright outside: `inner` is the node whose fronts are its inside.
Experiment closed_box(std::string name, vec3 at, bool double_walls) {
    Experiment e{
        .group = "darkness", .name = std::move(name), .scene = {}, .bakes = true, .resolution = 48};
    const int grey = add_grey(e.scene, 0.5f);
    const vec3 half{1, 1, 1}, shell{1.01f, 1.01f, 1.01f};
    const int inner = add_box(e.scene, grey, at - half, at + half, Facing::inwards);
    if (double_walls) add_box(e.scene, grey, at - shell, at + shell, Facing::outwards);
    shine_from_outside(e.scene, at);
    const float near = 0.99f;
    e.sensors = {sensor(at, {0, 1, 0}), sensor(at + vec3{near, near, near}, {0, -1, 0}),
                 sensor(at + vec3{-near, -near, 0}, {0, 1, 0})};
    const double reference = 80000;
    e.checks = {
        dark_sensors("E at the sensors inside", reference),
        {.quantity = "largest E of a texel inside",
         .source = "no way for light",
         .expected = 0,
         .read = [inner](const Evidence& found) { return max_over_node(*found.baked, inner); },
         .reference = reference}};
    return e;
}

}  // namespace

std::vector<Experiment> darkness() {
    return {
        behind_a_plate("plate that turns its front to the light", true),
        behind_a_plate("plate that turns its back to the light", false),
        behind_an_emitter(),
        on_a_convex_emitter(),
        beyond_the_cone(),
        closed_box("closed box", {0, 0, 0}, false),
        closed_box("closed box, 1 km from the origin", {1000, -1000, 1000}, false),
        closed_box("closed box, walls of 1 cm", {0, 0, 0}, true),
        closed_box("closed box, walls of 1 cm, 1 km from the origin", {1000, -1000, 1000}, true)};
}

}  // namespace aglow::validation
