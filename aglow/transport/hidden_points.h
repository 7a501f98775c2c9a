// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/mesh/texels.h"

namespace aglow {

/// Takes sample points that lie inside other geometry (a floor under a table leg) out of texels
/// that also have points in the open, so that what nobody sees does not darken what one sees. A
/// point counts as hidden when all its rays meet the backs of surfaces that are not double-sided.
/// Texels with hidden points only, next to a texel in the open, are no longer covered: the
/// gutter fill of the lightmap then reaches under the object and no dark seam shows round it.
/// Cost    one ray per sample point, and 8 more for points of texels that straddle.
/// Repeat  same bits for any thread count.
void drop_hidden_points(const Surfaces& surfaces, const Scene& scene, const RayScene& rays,
                        Texels& texels);

}  // namespace aglow
