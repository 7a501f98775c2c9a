// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow {
namespace {

/// Processor seconds on Mesa's llvmpipe, as `trace_bench rates` measures them from 10^4 to 10^6
/// triangles. Only the ratios matter for the choice; on another device they hold roughly.
struct Cost {
    Accel accel;
    double build;   ///< s for 10^6 triangles; builds are linear in their number
    double trace;   ///< s for 10^6 diffuse rays among 10^6 triangles ...
    double growth;  ///< ... and the power of the number of triangles with which that grows
};
constexpr std::array kCosts = {Cost{Accel::grid, 0.7, 10.5, 0.32},
                               Cost{Accel::grid2, 1.75, 5.0, 0.22},
                               Cost{Accel::bvh, 1.8, 3.5, 0.18}};
constexpr double kUnlimited = 1e15;  // rays; keeps sums finite

}  // namespace

const char* name(Accel accel) {
    constexpr std::array<const char*, 4> kNames = {"auto", "grid", "grid2", "bvh"};
    return kNames[static_cast<size_t>(accel)];
}

Accel choose_accel(const AccelDemand& demand) {
    const double mtris = static_cast<double>(std::max<uint64_t>(demand.triangles, 1)) / 1e6;
    const double mrays = std::min(demand.rays_per_build, kUnlimited) / 1e6;
    const auto seconds = [&](const Cost& cost) {
        return cost.build * mtris + mrays * cost.trace * std::pow(mtris, cost.growth);
    };
    return std::min_element(kCosts.begin(), kCosts.end(),
                            [&](const Cost& a, const Cost& b) { return seconds(a) < seconds(b); })
        ->accel;
}

}  // namespace aglow
