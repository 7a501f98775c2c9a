// SPDX-License-Identifier: Apache-2.0
// The wind-up toys of the built-in scene "toys": each adds itself on a table whose top is y = 0,
// and moves in a loop of kToyLoop seconds.
#pragma once
#include "aglow/scene/builtin/geometry.h"

namespace aglow::builtin {

inline constexpr float kToyLoop = 4;  // seconds

void add_train(SceneBuilder& scene);  ///< runs round a ring of rails about the origin
void add_boat(SceneBuilder& scene, vec3 place);
void add_duck(SceneBuilder& scene, vec3 place, float heading_degrees);

/// Adds a morph target that moves every vertex to `image` of it. Normals follow the triangles.
void add_target(Primitive& primitive, const std::function<vec3(vec3)>& image);

}  // namespace aglow::builtin
