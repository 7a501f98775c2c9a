// SPDX-License-Identifier: Apache-2.0
// The corner in which the small moving scenes are shown: floor, two walls, a luminous panel for
// soft light and a spot for hard shadows.
#pragma once
#include "aglow/scene/builtin/geometry.h"

namespace aglow::builtin {

struct Studio {
    float half = 2;          ///< m, half the side of its square floor about the origin
    float height = 3;        ///< m
    float floor_height = 0;  ///< m
    vec3 wall = {0.6f, 0.62f, 0.66f};
    float panel = 600;      ///< cd/m^2
    vec3 spot = {0, 0, 0};  ///< candela
    vec3 spot_position = {1.5f, 2.8f, 1.5f};
    vec3 spot_target = {0, 0, 0};
};

inline constexpr int64_t kStudioTriangles = 8;
/// Adds it; the floor is of material `floor`.
void add_studio(SceneBuilder& scene, const Studio& studio, int floor);

}  // namespace aglow::builtin
