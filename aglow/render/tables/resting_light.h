// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/encode/lit_gltf.h"

namespace aglow::render {

/// Baked light of a moving scene without what follows the motion: in every texel, what punctual
/// lights give directly in the rest pose is taken away (0 where that is more than there was). Rays
/// find that part again at any time. It is worked out for the same points of each texel as baking
/// does, so that no outline of a shadow at rest stays behind.
/// Result  irradiance, lux, of the lightmap's size.
/// Errors  cancelled, out_of_memory.
/// Cost    a shadow ray per light and point of a texel.   Repeat  same bits for any thread count.
Result<Image> resting_light(const Scene& scene, const Lit& lit, const Monitor& monitor);

}  // namespace aglow::render
