// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/studio.h"

namespace aglow::builtin {

void add_studio(SceneBuilder& scene, const Studio& studio, int floor) {
    const int wall = scene.diffuse("studio wall", studio.wall);
    const int panel =
        scene.luminous("studio panel", {0.8f, 0.8f, 0.8f}, vec3{1, 0.97f, 0.92f} * studio.panel);
    const auto corner = [&](float x, float y, float z) {
        return vec3{x * studio.half, studio.floor_height + y * studio.height, z * studio.half};
    };
    scene.add("studio floor",
              quad(corner(-1, 0, 1), corner(1, 0, 1), corner(1, 0, -1), corner(-1, 0, -1)), floor);
    Shape walls = quad(corner(-1, 0, -1), corner(1, 0, -1), corner(1, 1, -1), corner(-1, 1, -1));
    walls.append(quad(corner(-1, 0, 1), corner(-1, 0, -1), corner(-1, 1, -1), corner(-1, 1, 1)));
    scene.add("studio walls", walls, wall);
    constexpr float kPart = 0.4f;  // of the ceiling that the panel covers, along each side
    scene.add("studio panel",
              quad(corner(-kPart, 1, -kPart), corner(kPart, 1, -kPart), corner(kPart, 1, kPart),
                   corner(-kPart, 1, kPart)),
              panel);
    Light spot;
    spot.name = "spot";
    spot.intensity = studio.spot;
    spot.inner_cone = 0.35f;
    spot.outer_cone = 0.6f;
    scene.add_spot(spot, studio.spot_position, studio.spot_target);
}

}  // namespace aglow::builtin
