// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/texels.h"

#include <vector>

namespace aglow::transport::cpu {

/// From a point on a surface to the texel that holds its light.
class TexelMap {
public:
    TexelMap(const Surfaces& surfaces, const Texels& texels);

    /// Element whose light is that of the point's front, or kNoElement where there is none: no
    /// texel covers it, or a wall divides the one that does.
    uint32_t element(SurfacePoint at) const {
        const Corner& c = corners_[at.triangle];
        const vec2 uv = c.origin + c.along_1 * at.barycentrics.x + c.along_2 * at.barycentrics.y;
        const int x = clamp_to(uv.x, width_), y = clamp_to(uv.y, height_);
        return nearest_[static_cast<size_t>(y) * static_cast<size_t>(width_) +
                        static_cast<size_t>(x)];
    }

private:
    struct Corner {
        vec2 origin, along_1, along_2;
    };
    static int clamp_to(float value, int size) {
        const int cell = static_cast<int>(value);
        return cell < 0 ? 0 : cell >= size ? size - 1 : cell;
    }

    int width_, height_;
    std::vector<Corner> corners_;    // [triangle] lightmap coordinates, texels
    std::vector<uint32_t> nearest_;  // [pixel] its element, or that of a neighbour: a hit's
                                     // coordinates round into the next texel now and then
};

}  // namespace aglow::transport::cpu
