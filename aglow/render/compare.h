// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <span>

namespace aglow {

/// How far A is from B, over the pixels (texels) compared and all three channels. Where B is zero
/// everywhere, a relative figure is 0 if A equals B there, else infinite.
struct Difference {
    double rmse = 0;             ///< root of the mean squared difference, in the unit of the values
    double relative_rmse = 0;    ///< rmse / root mean square of B
    double mean_relative = 0;    ///< |mean(A) - mean(B)| / mean(B)
    double max = 0;              ///< largest absolute difference
    double median_relative = 0;  ///< median over pixels of |A - B| / B of luminance, where B > 0
    size_t count = 0;            ///< pixels compared
    size_t non_finite = 0;       ///< pixels left out because A or B is NaN or infinite
};

/// Shapes  both of the same size; `mask` empty or [height * width], nonzero where to compare.
/// Errors  bad_argument (sizes differ; says both).
/// Cost    O(pixels), sums in double.
Result<Difference> difference(const Image& a, const Image& b, std::span<const uint8_t> mask = {});

}  // namespace aglow
