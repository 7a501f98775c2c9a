// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/frames.h"
#include "aglow/vk/timing_table.h"

#include <vector>

namespace aglow::render::gpu {

/// GPU time of the passes in the order of their first work; what is left of `wall` seconds, in
/// which the GPU did nothing, comes last.
std::vector<PassTime> pass_times(const std::vector<vk::Timing>& timings, double wall);

}  // namespace aglow::render::gpu
