// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/device.h"

#include <cstdint>
#include <string_view>

namespace aglow::render::gpu {

/// Errors  out_of_memory  `device` has less than `needed` bytes free for `what`; says so, and ends
///                        with `advice`
Status check_room(const vk::Device& device, uint64_t needed, std::string_view what,
                  std::string_view advice);

}  // namespace aglow::render::gpu
