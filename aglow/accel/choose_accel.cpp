// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu_scene.h"

#include <array>

namespace aglow {

const char* name(Accel accel) {
    constexpr std::array<const char*, 4> kNames = {"auto", "grid", "grid2", "bvh"};
    return kNames[static_cast<size_t>(accel)];
}

Accel choose_accel(const AccelDemand& demand) {
    return demand.rays_per_build < 1000 ? Accel::grid : Accel::bvh;
}

}  // namespace aglow
