// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/transport/gather/cpu/texel_map.h"
#include "aglow/transport/gather/gather.h"

#include <span>

namespace aglow::transport::cpu {

/// Irradiance of one receiver and how sure it is.
struct Gathered {
    Irradiance irradiance;
    float standard_error = 0;  ///< of the total's luminance, lux
    uint32_t samples = 0;
};

/// Gathers at the mean of `points` (the sample points of a texel, or one sensor): rays go round the
/// points in turn, in doubling rounds, until the relative standard error, estimated from
/// the spread of batches, is below `target_error` of the larger of the receiver's own luminance
/// and `floor` (lux).
/// Repeat  depends on `index`, the options and the seed alone.
Gathered gather_points(const World& world, const TexelMap& map, const GatherCache& cache,
                       std::span<const Receiver> points, uint32_t index, float floor,
                       const GatherOptions& options, uint64_t& ray_count);

}  // namespace aglow::transport::cpu
