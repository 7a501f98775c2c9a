// SPDX-License-Identifier: Apache-2.0
// Light from infinity: uniform and pictured skies of 1000 cd/m^2, and the sun.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

#include <cmath>

namespace aglow::validation {
namespace {

constexpr double kLuminance = 1000;  // cd/m^2
constexpr double kExitance = kPi * kLuminance;

Sky uniform_sky() {
    const auto l = static_cast<float>(kLuminance);
    return {.luminance = {l, l, l}, .image = nullptr};
}

/// Ground under the sensors, 1 m below them; with `half` = 1000 m it reaches the horizon within
/// 0.06 degrees.
int add_ground(Scene& scene, float rho, float half) {
    return add_rectangle(scene, add_grey(scene, rho), {-half, -1, -half}, {0, 0, 2 * half},
                         {2 * half, 0, 0});
}

double ground_factor(Point normal, double half) {
    return rectangle_factor({0, 0, 0}, normal, {-half, -1, -half}, {0, 0, 2 * half},
                            {2 * half, 0, 0});
}

Experiment open_sky() {
    Experiment e{.group = "uniform sky", .name = "over black ground", .scene = {}};
    add_ground(e.scene, 0, 1000);
    e.scene.sky = uniform_sky();
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0, 0, 0}, {1, 0, 0})};
    e.checks = {
        total_at(0, "E horizontal", kExitance, "pi L"),
        total_at(1, "E vertical", kExitance * (1 - ground_factor({1, 0, 0}, 1000)), "pi L / 2")};
    return e;
}

Experiment reflecting_ground() {
    const double rho = 0.4;
    Experiment e{.group = "uniform sky", .name = "over grey ground", .scene = {}};
    add_ground(e.scene, static_cast<float>(rho), 1000);
    e.scene.sky = uniform_sky();
    e.sensors = {sensor({0, 0, 0}, {1, 0, 0})};
    const double ground = ground_factor({1, 0, 0}, 1000);
    e.checks = {
        total_at(0, "E vertical", kExitance * (1 - ground + rho * ground), "pi L (1 + rho) / 2")};
    return e;
}

Experiment beside_a_wall() {
    Experiment e{.group = "uniform sky", .name = "beside a black wall", .scene = {}};
    const int black = add_grey(e.scene, 0);
    add_rectangle(e.scene, black, {1.5f, 0, -2}, {0, 0, 4}, {0, 3, 0});
    e.scene.sky = uniform_sky();
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E horizontal", kExitance * (1 - 2 * corner_perpendicular(2, 3, 1.5)),
                         "pi L (1 - F of the wall)")};
    return e;
}

/// A black room with a hole of 2 x 1.5 m in one wall: 3 m wide, 2.7 m high.
Experiment through_a_window() {
    Experiment e{.group = "uniform sky", .name = "through a window of a black room", .scene = {}};
    Scene& scene = e.scene;
    const int black = add_grey(scene, 0);
    const vec3 lo{-2, 0, -1.5f}, hi{2, 2.7f, 1.5f};
    const float sill = 0.9f, head = 2.4f, side = 1;
    add_rectangle(scene, black, lo, {0, 0, 3}, {4, 0, 0});                  // floor
    add_rectangle(scene, black, {lo.x, hi.y, lo.z}, {4, 0, 0}, {0, 0, 3});  // ceiling
    add_rectangle(scene, black, lo, {0, 2.7f, 0}, {0, 0, 3});               // back
    add_rectangle(scene, black, lo, {4, 0, 0}, {0, 2.7f, 0});               // sides
    add_rectangle(scene, black, {lo.x, lo.y, hi.z}, {0, 2.7f, 0}, {4, 0, 0});
    add_rectangle(scene, black, {hi.x, 0, lo.z}, {0, 0, 3}, {0, sill, 0});  // round the hole
    add_rectangle(scene, black, {hi.x, head, lo.z}, {0, 0, 3}, {0, hi.y - head, 0});
    add_rectangle(scene, black, {hi.x, sill, lo.z}, {0, 0, hi.z - side}, {0, head - sill, 0});
    add_rectangle(scene, black, {hi.x, sill, side}, {0, 0, hi.z - side}, {0, head - sill, 0});
    scene.sky = uniform_sky();
    e.sensors = {sensor({0, 0.8f, 0.25f}, {0, 1, 0}), sensor({-1, 1.6f, 0}, {1, 0, 0})};
    const auto window = [](Point at, Point n) {
        return rectangle_factor(at, n, {2, 0.9, -1}, {0, 0, 2}, {0, 1.5, 0});
    };
    e.checks = {total_at(0, "E horizontal, 0.8 m high",
                         kExitance * window({0, 0.8, 0.25}, {0, 1, 0}), "pi L F of the window"),
                total_at(1, "E facing the window", kExitance * window({-1, 1.6, 0}, {1, 0, 0}),
                         "pi L F of the window")};
    return e;
}

Experiment overcast_sky() {
    Experiment e{.group = "sky image", .name = "CIE overcast", .scene = {}};
    add_ground(e.scene, 0, 1000);
    e.scene.sky = image_sky(256, [](vec3 d) {
        const float l = d.y > 0 ? static_cast<float>(kLuminance) * (1 + 2 * d.y) / 3 : 0;
        return vec3{l, l, l};
    });
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0, 0, 0}, {0, 0, -1})};
    // Integrals of Lz (1 + 2 sin(gamma)) / 3 times the cosine to the sensor's normal.
    e.checks = {total_at(0, "E horizontal", kExitance * 7 / 9, "7 pi Lz / 9"),
                total_at(1, "E vertical", kLuminance * (kPi / 6 + 4.0 / 9), "Lz (pi / 6 + 4 / 9)")};
    return e;
}

Experiment eastern_sky() {
    Experiment e{.group = "sky image", .name = "bright in the east only", .scene = {}};
    add_ground(e.scene, 0, 1);
    e.scene.sky = image_sky(256, [](vec3 d) {
        const float l = d.x > 0 ? static_cast<float>(kLuminance) : 0;
        return vec3{l, l, l};
    });
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({5, 0, 0}, {1, 0, 0}),
                 sensor({5, 0, 0}, {0, 0, -1})};
    e.checks = {total_at(0, "E horizontal", kExitance / 2, "pi L / 2"),
                total_at(1, "E facing east", kExitance, "pi L"),
                total_at(2, "E facing north", kExitance / 2, "pi L / 2")};
    return e;
}

Experiment sun() {
    const double azimuth = 120, elevation = 35, normal = 80000, degree = kPi / 180;
    Experiment e{.group = "sun", .name = "azimuth 120, elevation 35", .scene = {}};
    add_ground(e.scene, 0, 10);
    add_sun(e.scene, static_cast<float>(azimuth), static_cast<float>(elevation),
            static_cast<float>(normal));
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0, 0, 0}, {1, 0, 0}),
                 sensor({0, 0, 0}, {0, 0, 1})};
    const double flat = normal * std::cos(elevation * degree);
    e.checks = {
        total_at(0, "E horizontal", normal * std::sin(elevation * degree), "E_n sin(elevation)"),
        total_at(1, "E facing east", flat * std::sin(azimuth * degree),
                 "E_n cos(elevation) sin(azimuth)"),
        total_at(2, "E facing south", -flat * std::cos(azimuth * degree),
                 "-E_n cos(elevation) cos(azimuth)")};
    return e;
}

}  // namespace

std::vector<Experiment> skies() {
    return {open_sky(),
            reflecting_ground(),
            beside_a_wall(),
            through_a_window(),
            overcast_sky(),
            eastern_sky(),
            sun()};
}

}  // namespace aglow::validation
