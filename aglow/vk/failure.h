// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <vulkan/vulkan.h>

#include <string_view>

namespace aglow::vk {

/// The error of a Vulkan call that did not succeed. `doing` completes "... while": "opening it".
/// Errors  out_of_memory, device_lost (any failure of the driver), unsupported (what it lacks).
tl::unexpected<Error> failure(VkResult result, std::string_view doing);

}  // namespace aglow::vk
