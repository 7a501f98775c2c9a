// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/surfaces.h"
#include "aglow/mesh/unwrap.h"

#include <cstdint>
#include <vector>

namespace aglow {

inline constexpr uint32_t kNoElement = 0xffffffffu;

/// The covered texels of an atlas: the elements that light is solved for. A texel is covered if
/// any triangle of positive area overlaps its square, by however little (1e-5 of the square at
/// least, unless the triangle itself is tiny: that much is rounding). Its sample points lie
/// inside the covered part, spread in proportion to area, so that their mean is the texel's mean.
struct Texels {
    int width = 0, height = 0;
    std::vector<uint32_t> pixel_of;      ///< [element_count] y * width + x, increasing
    std::vector<uint32_t> element_at;    ///< [height * width] element, or kNoElement
    std::vector<uint32_t> first_sample;  ///< [element_count + 1] offsets into samples
    std::vector<SurfacePoint> samples;
    std::vector<float> area;  ///< [element_count] covered surface, m^2
    /// [element_count] 1 where a wall divides a texel and `samples` are of one side only, so that
    /// its light does not hold all over it; or empty: none is. See drop_hidden_points().
    std::vector<uint8_t> divided;

    size_t element_count() const { return pixel_of.size(); }
};

/// Finds the covered texels and puts up to `samples_per_texel` points into each (fewer only where
/// the covered part is a sliver; never none).
/// Shapes  surfaces.lightmap_uvs must be filled; the grid is width x height of the atlas.
/// Cost    O(triangles + covered texels).
/// Repeat  same bits for any thread count.
Texels rasterize(const Surfaces& surfaces, const Atlas& atlas, int samples_per_texel);

}  // namespace aglow
