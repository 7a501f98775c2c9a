// SPDX-License-Identifier: Apache-2.0
// Closed rooms, in which light is reflected until it is absorbed.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

#include <fmt/format.h>

namespace aglow::validation {
namespace {

constexpr int kRoomResolution = 96;  // texels: about 35 along each wall

Check mean_check(std::string quantity, Share share, double expected, std::string source) {
    return {.quantity = std::move(quantity),
            .source = std::move(source),
            .expected = expected,
            .read = [share](const Evidence& e) { return mean_over_node(*e.baked, -1, share); }};
}

/// Every wall emits and reflects alike, so that every point receives the same.
Experiment furnace(double rho) {
    const double luminance_of_walls = 100;
    Experiment e{.group = "furnace",
                 .name = fmt::format("rho = {:.1f}", rho),
                 .scene = {},
                 .bakes = true,
                 .resolution = kRoomResolution};
    const int material =
        add_grey(e.scene, static_cast<float>(rho), static_cast<float>(luminance_of_walls));
    add_box(e.scene, material, {-1, -1, -1}, {1, 1, 1}, Facing::inwards);
    const double expected = kPi * luminance_of_walls / (1 - rho);
    const char* source = "pi L / (1 - rho)";
    e.sensors = {sensor({0.1f, 0.2f, 0.3f}, {0, 1, 0}), sensor({0.95f, -0.9999f, 0.9f}, {0, 1, 0})};
    e.checks = {mean_check("mean E of the walls", Share::total, expected, source),
                total_at(0, "E in mid-air", expected, source),
                total_at(1, "E in a corner of the floor", expected, source)};
    return e;
}

constexpr double kFlux = 10000;  // lumen
constexpr double kCubeArea = 96;

Experiment cube(double rho, Facing facing) {
    Experiment e{
        .group = "cube 4 m, 10 klm", .name = fmt::format("rho = {:.1f}", rho), .scene = {}};
    add_box(e.scene, add_grey(e.scene, static_cast<float>(rho)), {-2, -2, -2}, {2, 2, 2}, facing);
    add_point_light(e.scene, {0, 0, 0}, static_cast<float>(kFlux));
    const double centre = cube_indirect(kFlux, rho).face_centre;
    const char* source = "integral equation of radiosity, see derivations/cube.md";
    e.resolution = kRoomResolution;
    // A tenth of a millimetre off the walls: on their inner side at every scale.
    e.sensors = {sensor({0, -1.9999f, 0}, {0, 1, 0}), sensor({1.9999f, 0, 0}, {-1, 0, 0})};
    e.checks = {indirect_at(0, "indirect E at the centre of the floor", centre, source),
                indirect_at(1, "indirect E at the centre of a wall", centre, source)};
    return e;
}

Experiment cube_from_within(double rho) {
    Experiment e = cube(rho, Facing::inwards);
    e.bakes = true;
    e.checks.push_back(
        mean_check("mean direct E", Share::direct, kFlux / kCubeArea, "flux / area"));
    e.checks.push_back(mean_check("mean indirect E", Share::indirect,
                                  kFlux / kCubeArea * rho / (1 - rho),
                                  "flux / area * rho / (1 - rho)"));
    return e;
}

/// Surfaces reflect on both sides: a cube that shows its backs to the light is lit the same.
Experiment cube_of_backs() {
    Experiment e = cube(0.5, Facing::outwards);
    e.name += ", backs inside";
    return e;
}

/// The same cube where coordinates carry seven digits only: a kilometre from the origin.
Experiment cube_far_away() {
    Experiment e = cube(0.5, Facing::inwards);
    e.name += ", 1 km from the origin";
    const vec3 far_away{1000, 1000, 1000};
    for (Node& node : e.scene.nodes) node.translation += far_away;
    // A millimetre off the floor: far more than the spacing of floats there, and too little for the
    // light to change by more than 0.03 %.
    e.sensors = {sensor(far_away + vec3{0, -1.999f, 0}, {0, 1, 0})};
    e.checks.resize(1);
    return e;
}

}  // namespace

std::vector<Experiment> rooms() {
    std::vector<Experiment> all;
    for (double rho : {0.2, 0.5, 0.8}) all.push_back(furnace(rho));
    for (double rho : {0.2, 0.5, 0.8}) all.push_back(cube_from_within(rho));
    all.push_back(cube_of_backs());
    all.push_back(cube_far_away());
    return all;
}

}  // namespace aglow::validation
