// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/toys.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr float kTrack = 0.46f;        // m, radius of the middle of the track
constexpr float kGauge = 0.05f;        // m between the rails
constexpr float kRailHeight = 0.012f;  // m
constexpr float kWheel = 0.02f;        // m, radius
constexpr float kAxle = kRailHeight + kWheel;

/// Axis along X, between -half and half.
Shape lying_cylinder(float radius, float half, int slices) {
    return cylinder({0, -half, 0}, radius, 2 * half, slices).turned({0, 0, 1}, 90);
}

Shape rails() {
    Shape shape;
    for (const float radius : {kTrack - kGauge / 2, kTrack + kGauge / 2}) {
        const std::array<vec2, 5> profile = {vec2{radius - 0.003f, 0.004f},
                                             {radius + 0.003f, 0.004f},
                                             {radius + 0.003f, kRailHeight},
                                             {radius - 0.003f, kRailHeight},
                                             {radius - 0.003f, 0.004f}};
        shape.append(lathe(profile, 64));
    }
    return shape;
}

Shape sleepers() {
    constexpr int kCount = 40;
    Shape shape;
    for (int i = 0; i < kCount; ++i)
        shape.append(box({kTrack - 0.04f, 0, -0.008f}, {kTrack + 0.04f, 0.004f, 0.008f})
                         .turned({0, 1, 0}, 360.0f * static_cast<float>(i) / kCount));
    return shape;
}

Shape engine_body() {
    // Boiler towards -Z, the way of a counter-clockwise ride where the track crosses +X.
    Shape shape =
        lying_cylinder(0.028f, 0.055f, 24).turned({0, 1, 0}, 90).moved({0, 0.066f, -0.02f});
    shape.append(rounded_box({-0.034f, 0.03f, 0.03f}, {0.034f, 0.115f, 0.085f}, 0.006f, 2));
    return shape;
}

Shape engine_trim() {
    const std::array<vec2, 6> stack = {vec2{0, 0.09f},   {0.008f, 0.09f},  {0.009f, 0.115f},
                                       {0.016f, 0.132f}, {0.013f, 0.136f}, {0, 0.136f}};
    const std::array<vec2, 5> dome = {
        vec2{0, 0.088f}, {0.011f, 0.088f}, {0.011f, 0.1f}, {0.007f, 0.107f}, {0, 0.11f}};
    Shape shape = lathe(stack, 24).moved({0, 0, -0.055f});
    shape.append(lathe(dome, 24).moved({0, 0, -0.012f}));
    shape.append(rounded_box({-0.04f, 0.113f, 0.022f}, {0.04f, 0.121f, 0.093f}, 0.003f, 1));
    shape.append(box({-0.03f, 0.026f, -0.085f}, {0.03f, 0.036f, 0.09f}));
    return shape;
}

Shape wagon_body() {
    const Lattice open{{-0.034f, -0.029f, 0.029f, 0.034f},
                       {0.036f, 0.041f, 0.075f},
                       {-0.062f, -0.057f, 0.057f, 0.062f},
                       [](int i, int j, int k) {
                           const bool inside =
                               i >= 0 && i < 3 && j >= 0 && j < 2 && k >= 0 && k < 3;
                           return inside && (j == 0 || i != 1 || k != 1);
                       }};
    return open.shape();
}

Shape load() {
    Shape shape;
    Dice dice(21);
    for (int i = 0; i < 9; ++i)
        shape.append(sphere({dice.between(-0.015f, 0.015f), 0.064f + dice.between(0, 0.014f),
                             (static_cast<float>(i) - 4) * 0.011f},
                            0.014f, 8, 6));
    return shape;
}

Shape wheel_pair() {
    Shape shape = lying_cylinder(0.004f, kGauge / 2, 8);
    for (const float side : {-0.5f, 0.5f})
        shape.append(lying_cylinder(kWheel, 0.005f, 16).moved({side * kGauge, 0, 0}));
    for (const float side : {-0.5f, 0.5f})  // bosses off the centre show that the wheels turn
        shape.append(lying_cylinder(0.005f, 0.007f, 8).moved({side * kGauge, 0.011f, 0}));
    return shape;
}

void add_wheels(SceneBuilder& scene, int car, int mesh, std::initializer_list<float> places) {
    const float turns = kTrack / kWheel;  // for one round; a whole number joins on to itself
    for (const float z : places) {
        const int axle = scene.add_node("axle", mesh);
        scene.node(axle).translation = {0, kAxle, z};
        scene.attach(axle, car);
        scene.spin(axle, {-1, 0, 0}, static_cast<int>(std::lround(turns)), kToyLoop);
    }
}

}  // namespace

void add_train(SceneBuilder& scene) {
    const int steel = scene.metal("rail", {0.6f, 0.6f, 0.62f}, 0.25f);
    const int wood = scene.diffuse("sleeper", {0.2f, 0.12f, 0.07f});
    const int green = scene.glossy("green paint", {0.03f, 0.24f, 0.1f}, 0.2f);
    const int red = scene.glossy("red paint", {0.6f, 0.05f, 0.04f}, 0.2f);
    const int brass = scene.metal("brass", {0.8f, 0.6f, 0.28f}, 0.15f);
    const int black = scene.glossy("black paint", {0.03f, 0.03f, 0.03f}, 0.3f);
    const int coal = scene.diffuse("coal", {0.05f, 0.05f, 0.055f});

    scene.add("track", {{rails(), steel}, {sleepers(), wood}});
    const int turntable = scene.add_node("train");
    scene.spin(turntable, {0, 1, 0}, 1, kToyLoop);
    const int wheels = scene.add_mesh("wheels", {{wheel_pair(), black}});
    const int wagon = scene.add_mesh("wagon", {{wagon_body(), red}, {load(), coal}});
    const int engine = scene.add_mesh("engine", {{engine_body(), green}, {engine_trim(), brass}});
    for (int i = 0; i < 4; ++i) {
        const float degrees = -22.0f * static_cast<float>(i);
        const float angle = degrees * kPi / 180;
        const int car = scene.add_node(i == 0 ? "engine" : "wagon", i == 0 ? engine : wagon);
        scene.node(car).translation = {kTrack * std::cos(angle), 0, -kTrack * std::sin(angle)};
        scene.node(car).rotation = turn({0, 1, 0}, degrees);
        scene.attach(car, turntable);
        add_wheels(scene, car, wheels, {-0.045f, 0.045f});
    }
}

}  // namespace aglow::builtin
