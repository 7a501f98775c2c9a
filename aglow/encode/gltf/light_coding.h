// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/encode/lightmap.h"

#include <cstdint>
#include <vector>

namespace aglow::encode {

/// Irradiance as an 8-bit picture: E = intensity * texel, sRGB-coded.
struct CodedLight {
    std::vector<uint8_t> png;
    double intensity = 1;      ///< lux; two significant digits
    double clipped_share = 0;  ///< of the covered texels
};

/// The least number with two significant digits that is not below `value`; 1 for 0.
double round_up(double value);

/// Chooses the intensity at or above the 99.9th percentile of the covered texels' largest channel,
/// so that a few glints do not cost all other texels their precision.
/// Errors  out_of_memory.
Result<CodedLight> code_light(const Lightmap& lightmap);

/// PNG of `scale` times the pixels, clipped to 0..1 and sRGB-coded, with alpha where it is not
/// empty.
/// Shapes  alpha: [pixels] or empty.   Errors  out_of_memory.
Result<std::vector<uint8_t>> srgb_png(const Image& image, float scale,
                                      const std::vector<float>& alpha = {});

}  // namespace aglow::encode
