// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/render/camera.h"

#include <array>

namespace aglow::render::gpu {

/// From places relative to the camera to clip space: clip coordinate i is dot(rows[i], (p - eye,
/// 1)). Depth is 1 at `near` and falls to 0: without end in perspective, at `far` without.
struct Projection {
    vec3 eye;
    std::array<vec4, 4> rows;

    vec4 clip(vec3 p) const;
    /// False only if nothing in the box can be seen.
    bool may_see(const Box& box) const;
};

/// Of a scene within `bounds`, of which a camera inside sees what is nearer than any detail.
Projection projection_of(const View& view, const Box& bounds);

/// Bounds of a transformed box.
Box transformed(const mat4& to_world, const Box& box);

}  // namespace aglow::render::gpu
