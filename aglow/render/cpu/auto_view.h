// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/camera.h"

namespace aglow::render::cpu {

/// A view of a scene without cameras, see choose_view().
/// Cost    some thousand rays.
/// Repeat  same view every time.
View automatic_view(const Surfaces& surfaces, const RayScene& rays, int width, int height);

/// Camera at `eye` that looks at `target`, +Y up.
mat4 look_at(vec3 eye, vec3 target);

/// Half extents of a perspective image: `y_fov` is vertical (radians) where the image is wider
/// than `aspect`, and what keeps the horizontal one where it is narrower; 0: no aspect to keep.
View perspective_view(const mat4& to_world, float y_fov, float aspect, int width, int height);

}  // namespace aglow::render::cpu
