// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/builtin/scenes.h"

#include <array>

namespace aglow::builtin {
namespace {

// Plan of the U, north (-Z) on top: the ceiling of cell L shines. A line of sight that leaves the
// lit leg reaches at most 0.6 m into the passage, and one that leaves the far leg's upper cells
// as little from its own side: light must turn on two surfaces in between.
constexpr int kColumns = 5, kRows = 5;
constexpr std::array<const char*, kRows> kPlan = {"L...D",  //
                                                  "A...D",  //
                                                  "A...D",  //
                                                  "A...D",  //
                                                  "APPPD"};
constexpr float kHeight = 2.5f;

char cell(int column, int row) {
    const bool inside = column >= 0 && row >= 0 && column < kColumns && row < kRows;
    return inside ? kPlan[static_cast<size_t>(row)][column] : '.';
}

}  // namespace

Scene corridor() {
    Lattice plan;
    plan.x = {-5, -3, -1, 1, 3, 5};
    plan.y = {0, kHeight};
    plan.z = {-5, -4, -2, 0, 3, 5};
    plan.solid = [](int i, int j, int k) { return j != 0 || cell(i, k) == '.'; };

    Shape grey, orange, blue, panel;
    plan.skin([&](const Lattice::Face& face) -> Shape& {
        const vec3 p = face.center;
        if (face.normal.y < -0.5f && p.x < -3 && p.z < -4) return panel;
        if (face.normal.y != 0) return grey;
        if (p.x >= 3) return blue;
        return p.x > -3 ? orange : grey;
    });

    SceneBuilder scene("corridor");
    const int grey_paint = scene.diffuse("grey", {0.7f, 0.7f, 0.7f});
    const int orange_paint = scene.diffuse("orange", {0.7f, 0.4f, 0.15f});
    const int blue_paint = scene.diffuse("blue", {0.3f, 0.45f, 0.7f});
    const int light = scene.luminous("panel", {0.7f, 0.7f, 0.7f}, {5000, 5000, 5000});
    scene.add("corridor",
              {{grey, grey_paint}, {orange, orange_paint}, {blue, blue_paint}, {panel, light}});
    scene.look({-4.5f, 1.6f, 4.6f}, {-0.5f, 1.3f, 3.6f}, 60);
    return scene.take();
}

}  // namespace aglow::builtin
