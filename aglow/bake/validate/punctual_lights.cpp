// SPDX-License-Identifier: Apache-2.0
// E = I cos(theta) / r^2 and its kin.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"
#include "aglow/core/assert.h"
#include "aglow/scene/photometry.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace aglow::validation {
namespace {

constexpr double kDegree = kPi / 180;

/// A scene needs a surface; this one lies below every sensor, is black and in nobody's way.
Scene black_plate() {
    Scene scene;
    add_rectangle(scene, add_grey(scene, 0), {-1, -1, -1}, {0, 0, 2}, {2, 0, 0});
    return scene;
}

Light point(float candela) {
    return {.name = "lamp", .kind = LightKind::point, .intensity = {candela, candela, candela}};
}

Experiment point_light() {
    Experiment e{.group = "point light", .name = "in the open", .scene = black_plate()};
    add_light(e.scene, point(100), {0, 2, 0});
    const float slant = std::sqrt(3.0f);
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({slant * 2, 0, 0}, {0, 1, 0}),
                 sensor({slant * 2, 0, 0}, {-slant / 2, 0.5f, 0})};
    e.checks = {total_at(0, "E below", 100.0 / 4, "I / r^2"),
                total_at(1, "E at 60 degrees", 100.0 / 16 * 0.5, "I cos(theta) / r^2"),
                total_at(2, "E facing the light", 100.0 / 16, "I / r^2")};
    return e;
}

Experiment two_point_lights() {
    Experiment e{.group = "point light", .name = "two of unlike colour", .scene = black_plate()};
    Light red = point(100), green = point(50);
    red.intensity = {100, 0, 0};
    green.intensity = {0, 50, 0};
    add_light(e.scene, red, {0, 2, 0});
    add_light(e.scene, green, {0, 1, 0});
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E below", 0.2126 * 25 + 0.7152 * 50, "sum of Y I / r^2")};
    return e;
}

Experiment spot_light() {
    const double inner = 20 * kDegree, outer = 40 * kDegree;
    Experiment e{.group = "spot", .name = "smooth cone", .scene = black_plate()};
    Light light = point(1000);
    light.kind = LightKind::spot;
    light.inner_cone = static_cast<float>(inner);
    light.outer_cone = static_cast<float>(outer);
    add_light(e.scene, light, {0, 2, 0}, {0, -1, 0});
    for (double degrees : {0.0, 15.0, 25.0, 30.0, 35.0}) {
        const double angle = degrees * kDegree, c = std::cos(angle);
        const double expected = 1000 * spot_falloff(angle, inner, outer) * c * c * c / 4;
        const int whole = static_cast<int>(degrees);
        e.checks.push_back(total_at(e.sensors.size(),
                                    "E at " + std::to_string(whole) + " degrees off the axis",
                                    expected, "I f(theta) cos(theta)^3 / h^2"));
        e.sensors.push_back(sensor({static_cast<float>(2 * std::tan(angle)), 0, 0}, {0, 1, 0}));
    }
    return e;
}

Experiment tilted_spot() {
    Experiment e{.group = "spot", .name = "aimed along a slant", .scene = black_plate()};
    Light light = point(1000);
    light.kind = LightKind::spot;
    light.inner_cone = static_cast<float>(10 * kDegree);
    light.outer_cone = static_cast<float>(20 * kDegree);
    // 3-4-5: from (3, 4, 0) towards the origin.
    add_light(e.scene, light, {3, 4, 0}, {-0.6f, -0.8f, 0});
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0})};
    e.checks = {total_at(0, "E on its axis", 1000.0 / 25 * 0.8, "I cos(theta) / r^2")};
    return e;
}

Experiment directional_light() {
    Experiment e{
        .group = "directional", .name = "30 degrees off the vertical", .scene = black_plate()};
    Light light = point(1000);
    light.kind = LightKind::directional;
    const float sine = 0.5f, cosine = std::sqrt(0.75f);
    add_light(e.scene, light, {0, 0, 0}, {sine, -cosine, 0});
    e.sensors = {sensor({0, 0, 0}, {0, 1, 0}), sensor({0, 0, 0}, {-1, 0, 0})};
    e.checks = {total_at(0, "E horizontal", 1000 * std::sqrt(0.75), "E_n cos(theta)"),
                total_at(1, "E vertical", 500, "E_n cos(theta)")};
    return e;
}

/// A luminaire as a file of measurements every degree tells it, from an LM-63 text.
Light luminaire(const std::string& planes, const std::vector<double>& plane_angles,
                double (*candela)(double c, double gamma)) {
    std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 91 " +
                       std::to_string(plane_angles.size()) + " 1 2 0 0 0\n1 1 0\n";
    for (int gamma = 0; gamma <= 90; ++gamma) text += std::to_string(gamma) + "\n";
    text += planes + "\n";
    for (const double c : plane_angles)
        for (int gamma = 0; gamma <= 90; ++gamma)
            text += std::to_string(candela(c * kDegree, gamma * kDegree)) + "\n";
    auto photometry = read_photometry({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    AG_ASSERT(photometry.has_value(), "a file made here");
    Light light;
    light.name = "luminaire";
    light.kind = LightKind::photometric;
    light.photometry = std::make_shared<const Photometry>(std::move(*photometry));
    return light;
}

Experiment cosine_luminaire() {
    Experiment e{.group = "luminaire", .name = "I0 cos(gamma)", .scene = black_plate()};
    add_light(e.scene,
              luminaire("0", {0}, [](double, double gamma) { return 1000 * std::cos(gamma); }),
              {0, 2, 0}, {0, -1, 0});
    const std::pair<const char*, double> angles[] = {{"0", 0}, {"30.5", 30.5}, {"60", 60}};
    for (const auto& [name, degrees] : angles) {
        const double angle = degrees * kDegree;
        e.checks.push_back(total_at(e.sensors.size(),
                                    std::string("E at ") + name + " degrees off the axis",
                                    250 * std::pow(std::cos(angle), 4), "I0 cos(theta)^4 / h^2"));
        e.sensors.push_back(sensor({static_cast<float>(2 * std::tan(angle)), 0, 0}, {0, 1, 0}));
    }
    return e;
}

Experiment wall_washer() {
    Experiment e{
        .group = "luminaire", .name = "brighter to one side, turned down", .scene = black_plate()};
    const auto candela = [](double c, double gamma) {
        return 100 + 50 * std::cos(c) * std::sin(gamma);
    };
    Light light = luminaire("0 30 60 90 120 150 180", {0, 30, 60, 90, 120, 150, 180}, candela);
    light.intensity = {1, 0.5f, 0};
    add_luminaire(e.scene, {0, 2, 0}, light.photometry);  // C0 to the east
    e.scene.lights.back().intensity = light.intensity;
    const double tint = 0.2126 + 0.7152 * 0.5, side = std::sqrt(0.5);
    const auto expected = [&](double along_c0) { return tint * (100 + 50 * along_c0) / 8 * side; };
    e.sensors = {sensor({2, 0, 0}, {0, 1, 0}), sensor({-2, 0, 0}, {0, 1, 0}),
                 sensor({0, 0, -2}, {0, 1, 0})};
    e.checks = {total_at(0, "E to the bright side", expected(side), "I(C, gamma) cos(theta) / r^2"),
                total_at(1, "E to the dark side", expected(-side), "I(C, gamma) cos(theta) / r^2"),
                total_at(2, "E between them", expected(0), "I(C, gamma) cos(theta) / r^2")};
    return e;
}

}  // namespace

std::vector<Experiment> punctual_lights() {
    return {point_light(),       two_point_lights(), spot_light(), tilted_spot(),
            directional_light(), cosine_luminaire(), wall_washer()};
}

}  // namespace aglow::validation
