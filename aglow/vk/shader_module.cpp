// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/shader_module.h"

#include "aglow/vk/failure.h"

#include <fmt/format.h>

namespace aglow::vk {

Result<ShaderModule> make_module(VkDevice device, std::span<const uint32_t> spirv,
                                 std::string_view doing) {
    constexpr uint32_t kSpirvMagic = 0x07230203;
    if (spirv.size() < 5 || spirv[0] != kSpirvMagic)
        return fail(Errc::unsupported, fmt::format("found no SPIR-V while {}", doing));
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult result = vkCreateShaderModule(device, &info, nullptr, &module);
    if (result != VK_SUCCESS) return failure(result, doing);
    return ShaderModule(device, module);
}

Result<PipelineLayout> make_layout(VkDevice device, VkShaderStageFlags stages, uint32_t push_bytes,
                                   std::string_view doing) {
    VkPushConstantRange range{stages, 0, push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkResult result = vkCreatePipelineLayout(device, &info, nullptr, &layout);
    if (result != VK_SUCCESS) return failure(result, doing);
    return PipelineLayout(device, layout);
}

tl::unexpected<Error> pipeline_failure(VkResult result, std::string_view doing) {
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        return failure(result, doing);
    return fail(Errc::unsupported, fmt::format("the driver refused (Vulkan error {}) {}; a "
                                               "newer driver may take it",
                                               static_cast<int>(result), doing));
}

}  // namespace aglow::vk
