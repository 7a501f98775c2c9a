// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/encode/lightmap.h"
#include "aglow/mesh/surfaces.h"

#include <cstdint>
#include <vector>

namespace aglow::encode {

/// What each texel looks like under its light, as PNG: 2^exposure_ev * luminance / kReferenceWhite,
/// luminance = emission + base colour / pi * irradiance, clipped at 1; with alpha where any texel
/// is not opaque. Unlit materials show their base colour as it is.
/// Errors  out_of_memory.
Result<std::vector<uint8_t>> unlit_picture(const Scene& scene, const Surfaces& surfaces,
                                           const Texels& texels, const Lightmap& lightmap,
                                           float exposure_ev);

}  // namespace aglow::encode
