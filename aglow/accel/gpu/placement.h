// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/shared/ray.h"

#include <optional>

namespace aglow::accel::gpu {

inline constexpr shared::Affine kIdentity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};

/// Where a rigid body has gone: from its reference pose to the world, and back.
struct Placement {
    shared::Affine to_world = kIdentity;
    shared::Affine to_local = kIdentity;
    float stretch = 1;  ///< root mean square of the factors by which to_world lengthens
};

/// The way from `reference` to `transform`: to_world = transform * inverse(reference), worked out
/// in double precision. Nothing where one of them is not finite or cannot be inverted.
std::optional<Placement> placement(const mat4& reference, const mat4& transform);

/// Box around `box` moved by `map`, and as much more as rounding can add when rays are moved back.
shared::Bounds moved_box(const shared::Bounds& box, const shared::Affine& map);

}  // namespace aglow::accel::gpu
