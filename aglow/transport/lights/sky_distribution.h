// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

#include <vector>

namespace aglow::transport {

/// Direction of a point (u, v) in [0, 1]^2 of an equirectangular image, and back: -Z at the centre
/// column, +X to its right, +Y on top.
vec3 equirectangular_direction(vec2 uv);
vec2 equirectangular_uv(vec3 direction);

/// Draws directions in proportion to a sky image's luminance.
class SkyDistribution {
public:
    SkyDistribution() = default;
    explicit SkyDistribution(const Image& sky);

    struct Sample {
        vec3 direction;
        float pdf;  ///< 1/sr
    };
    Sample draw(vec2 u) const;
    float pdf(vec3 direction) const;  ///< 1/sr
    bool black() const { return rows_.empty(); }

private:
    float density(int x, int y) const;  ///< over the unit square
    int width_ = 0, height_ = 0;
    std::vector<double> rows_;   // [height + 1] cumulative weight of rows, last = 1
    std::vector<double> cells_;  // [height][width + 1] cumulative within each row, last = 1
};

}  // namespace aglow::transport
