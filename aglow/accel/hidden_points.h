// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/mesh/texels.h"

namespace aglow {

/// Takes sample points that lie inside other geometry (a floor under a table leg) out of texels
/// that also have points in the open, so that what nobody sees does not darken what one sees. A
/// point counts as hidden when all its rays meet the backs of surfaces that are not double-sided.
/// Such texels are marked as divided. Where a wall stands across a texel, only the points of its
/// greater side stay: light of one room does not leak into the next through the floor that both
/// share. Hidden texels that hang together with texels in the open count as not covered: the
/// gutter fill of the lightmap then reaches under the object, and no dark seam shows round it. A
/// texel is given up on the word of 64 rays from each of its points only, so that a floor under a
/// low one-sided table keeps its light.
/// Cost    two rays per sample point; 8 more for texels that see a back, 64 more for hidden ones.
/// Repeat  same bits for any thread count.
void drop_hidden_points(const Surfaces& surfaces, const Scene& scene, const RayScene& rays,
                        Texels& texels);

}  // namespace aglow
