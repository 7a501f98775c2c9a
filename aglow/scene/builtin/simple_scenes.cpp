// SPDX-License-Identifier: Apache-2.0
// The small scenes whose light can be checked against closed forms and published pictures.
#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/builtin/scenes.h"

#include <array>

namespace aglow::builtin {
namespace {

/// Quads of the Cornell data, given in millimetres.
Shape quads(std::initializer_list<std::array<vec3, 4>> corners) {
    constexpr float kMetresPerMillimetre = 1e-3f;
    Shape shape;
    for (const auto& q : corners)
        shape.append(quad(q[0] * kMetresPerMillimetre, q[1] * kMetresPerMillimetre,
                          q[2] * kMetresPerMillimetre, q[3] * kMetresPerMillimetre));
    return shape;
}

Shape short_block() {
    return quads({{{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
                  {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
                  {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
                  {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
                  {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}});
}

Shape tall_block() {
    return quads({{{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
                  {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
                  {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
                  {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
                  {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}});
}

/// The same emission in every direction and colour as the box's lamp had: its published RGB,
/// scaled to a luminance of 10 000 cd/m^2.
vec3 cornell_luminance() {
    constexpr vec3 kPublished{18.4f, 15.6f, 8.0f};
    return kPublished * (10'000 / luminance(kPublished));
}

}  // namespace

// Measurements: Cornell University Program of Computer Graphics, "The Cornell Box". Their frame
// is right-handed with +Y up already; the picture's right is their -X, as for any camera that
// looks along +Z.
Scene cornell_box() {
    SceneBuilder scene("cornell-box");
    const int white = scene.diffuse("white", {0.73f, 0.73f, 0.73f});
    const int red = scene.diffuse("red", {0.63f, 0.065f, 0.05f});
    const int green = scene.diffuse("green", {0.14f, 0.45f, 0.091f});
    const int lamp = scene.luminous("lamp", {0.78f, 0.78f, 0.78f}, cornell_luminance());

    scene.add("floor", quads({{{{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}}}}),
              white);
    scene.add(
        "ceiling",
        quads({{{{556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}}}}),
        white);
    scene.add(
        "back wall",
        quads(
            {{{{549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}}}}),
        white);
    scene.add("right wall",
              quads({{{{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}}}}), green);
    scene.add(
        "left wall",
        quads({{{{552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}}}}),
        red);
    scene.add("short block", short_block(), white);
    scene.add("tall block", tall_block(), white);
    // 0.2 mm below the ceiling, so that the two do not share a plane.
    constexpr float kLampHeight = 548.6f;
    scene.add("lamp",
              quads({{{{343, kLampHeight, 227},
                       {343, kLampHeight, 332},
                       {213, kLampHeight, 332},
                       {213, kLampHeight, 227}}}}),
              lamp);
    // The published camera: 35 mm lens over a film 25 mm square.
    scene.look({0.278f, 0.273f, -0.8f}, {0.278f, 0.273f, 0}, 39.3077f);
    return scene.take();
}

Scene furnace() {
    SceneBuilder scene("furnace");
    const int wall = scene.luminous("wall", {0.5f, 0.5f, 0.5f}, {100, 100, 100});
    scene.add("cube", box({-1, -1, -1}, {1, 1, 1}).flipped(), wall);
    scene.look({-0.8f, 0.2f, 0.8f}, {0, 0, 0}, 60);
    return scene.take();
}

// Case 5.8 of CIE 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs":
// indirect light in a closed diffuse cube.
Scene cube_tc58() {
    constexpr float kFlux = 10'000;  // lm
    SceneBuilder scene("cube-tc58");
    const int wall = scene.diffuse("wall", {0.5f, 0.5f, 0.5f});
    scene.add("cube", box({-2, -2, -2}, {2, 2, 2}).flipped(), wall);
    Light light;
    light.name = "lamp";
    light.intensity = vec3{1, 1, 1} * (kFlux / (4 * kPi));
    scene.add_light(light, {0, 0, 0});
    scene.look({-1.8f, 0.5f, 1.8f}, {0, -0.3f, 0}, 70);
    return scene.take();
}

}  // namespace aglow::builtin
