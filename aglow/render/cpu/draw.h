// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/cpu/lighting.h"
#include "aglow/render/rays.h"

namespace aglow::render::cpu {

/// Errors  bad_argument (samples or reflections out of range).
Status check(const RaysOptions& options);

/// What all frames share. `surfaces` are those of the scene in its rest pose; light is `baked` or
/// to be computed on the spot.
SharedTables shared_tables(const Scene& scene, const Surfaces& surfaces, bool baked,
                           const RaysOptions& options);

/// Draws the picture that render_rays() describes; adds the rays it traces to `tally`.
/// Errors  bad_argument (empty view, surfaces without lightmap_uvs), cancelled, out_of_memory.
Result<Image> draw(const World& world, const View& view, const RaysOptions& options,
                   const Monitor& monitor, RayTally& tally);

}  // namespace aglow::render::cpu
