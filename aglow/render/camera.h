// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <string_view>

namespace aglow {

/// Camera of an image: from pixel positions to rays.
struct View {
    mat4 to_world;  ///< camera looks along -Z, +Y up, unit axes
    bool perspective = true;
    float half_width = 1;  ///< tan of half the horizontal field of view, or m (orthographic)
    float half_height = 1;
    int width = 0, height = 0;

    /// Ray through (x, y) in pixels, (0, 0) the outer corner of the top left one.
    Ray ray(float x, float y) const;
};

/// Picks a camera: a number, a name, or "auto": the file's first camera, else one placed so that
/// the scene fills the view (inside looking across, where the scene is a closed room).
/// Errors  bad_argument (no such camera; names those there are).
Result<View> choose_view(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                         std::string_view camera, int width, int height, double time);

}  // namespace aglow
