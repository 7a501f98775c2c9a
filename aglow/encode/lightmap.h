// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/mesh/texels.h"
#include "aglow/mesh/unwrap.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

/// Irradiance in lux over the atlas.
struct Lightmap {
    Image irradiance;  ///< [atlas.height x atlas.width] lux, gutters filled
    std::vector<uint8_t>
        covered;  ///< [same] 1 where a texel is covered, 0 in gutters and free space
};

/// Lays the values of the covered texels out as an image and fills gutters: every free texel within
/// `gutter` texels of a covered one takes the mean of its nearest neighbours, so that bilinear
/// look-ups inside a chart never meet an empty texel (for gutter >= 1). Covered texels keep their
/// values; free space further off is black.
/// Shapes  irradiance has one value per element of `texels`.
/// Cost    O(width * height * gutter).
/// Repeat  same bits for any thread count.
Lightmap make_lightmap(const Texels& texels, std::span<const vec3> irradiance, int gutter);

/// Bilinear look-up at lightmap coordinates in texels (pixel centres at k + 0.5), clamped to the
/// edge. Black for an empty image.
vec3 sample_lightmap(const Image& irradiance, vec2 texel);

}  // namespace aglow
