// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"
#include "aglow/shared/camera.h"

#include <optional>
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
    shared::CameraView shared_view() const;  ///< the same for shaders
};

/// Picks a camera: a number, a name (of a camera or of its node), or "auto": the first camera that
/// stands in the active scene, else one placed so that the scene fills the view: for an object,
/// from outside at a three-quarter angle; for a closed room, from inside one of its corners at
/// 60 % of its height; for a room with one side open, from outside through that.
///
/// An image wider than the camera's aspect keeps its vertical field of view, a narrower one its
/// horizontal one, so that all the camera frames is seen. Scale and mirroring of the camera's
/// nodes do not count (glTF 2.0, section 3.10.1).
/// Errors  bad_argument (no such camera; names those there are).
Result<View> choose_view(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                         std::string_view camera, int width, int height, double time);

/// A camera as choose_view() picks it, where its node puts it at any time.
/// Result  none for "auto" in a scene without cameras: what choose_view() then shows depends on the
///         pose, and should be chosen once for a sequence.
/// Errors  bad_argument (no such camera, an empty image).
Result<std::optional<View>> camera_view(const Scene& scene, std::string_view camera, int width,
                                        int height, double time);

}  // namespace aglow
