// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aglow::bake::fair {

/// A triangle of a chart, in texels: centres lie at k + 0.5.
using ChartTriangle = std::array<vec2, 3>;

/// Where in a triangle a texel is: barycentrics of corners 1 and 2.
struct ChartTexel {
    uint32_t triangle = UINT32_MAX;  ///< UINT32_MAX: in none
    vec2 barycentrics = {0, 0};
    bool inside = false;  ///< else it is a gutter's, and this is the place next to its centre
};

/// For each texel the triangle that its centre is in, or the nearest one within `gutter` texels.
/// Shapes  result [height * width]
/// Repeat  the lower-numbered of triangles that are equally near.
std::vector<ChartTexel> chart_texels(std::span<const ChartTriangle> triangles, int width,
                                     int height, float gutter);

}  // namespace aglow::bake::fair
