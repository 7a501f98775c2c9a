// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/room.h"
#include "aglow/scene/builtin/scenes.h"

namespace aglow::builtin {
namespace {

/// Low enough to reach across the rug to the sofa.
void add_afternoon_sun(SceneBuilder& scene) {
    constexpr float kAzimuth = 206, kElevation = 33;  // degrees, clockwise from north; above ground
    constexpr float kIlluminance = 20'000;            // lux on a plane that faces the sun
    constexpr vec3 kColor{1.0f, 0.90f, 0.76f};
    Light sun;
    sun.name = "sun";
    sun.kind = LightKind::directional;
    sun.intensity = kColor * (kIlluminance / luminance(kColor));
    scene.add_directional(std::move(sun), kAzimuth, kElevation);
}

}  // namespace

Scene living_room() {
    SceneBuilder scene("living-room");
    room::Paints paints{};
    paints.white = scene.diffuse("white wall", {0.80f, 0.78f, 0.74f});
    paints.trim = scene.diffuse("trim", {0.78f, 0.77f, 0.75f});
    paints.oak = scene.diffuse("oak", {0.44f, 0.28f, 0.15f});
    paints.dark_wood = scene.diffuse("walnut", {0.16f, 0.085f, 0.045f});
    paints.brass = scene.diffuse("brass", {0.50f, 0.36f, 0.14f});
    paints.ceramic = scene.diffuse("ceramic", {0.72f, 0.70f, 0.66f});
    paints.linen = scene.diffuse("linen", {0.74f, 0.69f, 0.61f});
    paints.black = scene.diffuse("black metal", {0.035f, 0.035f, 0.04f});

    add_shell(scene, paints);
    add_windows(scene, paints);
    add_garden(scene, paints);
    add_textiles(scene, paints);
    add_seats(scene, paints);
    add_tables(scene, paints);
    add_sideboard(scene, paints);
    add_bookshelf(scene, paints);
    add_pictures(scene, paints);
    add_plant(scene);
    add_lamps(scene, paints);
    add_afternoon_sun(scene);

    scene.look({-2.32f, 1.5f, -1.78f}, {0.72f, 0.93f, 0.85f}, 52);
    return scene.take();
}

}  // namespace aglow::builtin
