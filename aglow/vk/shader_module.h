// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/handle.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace aglow::vk {

/// `doing` completes "... while" in errors, as in failure(). Words that are no SPIR-V are refused.
Result<ShaderModule> make_module(VkDevice device, std::span<const uint32_t> spirv,
                                 std::string_view doing);

/// A layout of nothing but `push_bytes` bytes of push constants that `stages` see.
Result<PipelineLayout> make_layout(VkDevice device, VkShaderStageFlags stages, uint32_t push_bytes,
                                   std::string_view doing);

/// The error of a pipeline that could not be made: out_of_memory, or unsupported.
tl::unexpected<Error> pipeline_failure(VkResult result, std::string_view doing);

}  // namespace aglow::vk
