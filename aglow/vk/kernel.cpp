// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/kernel.h"

#include "aglow/vk/device.h"
#include "aglow/vk/failure.h"
#include "aglow/vk/kernel_rate.h"
#include "aglow/vk/shader_module.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace aglow::vk {

namespace {

constexpr uint32_t kPushBytes = 128;  // every device has as many

struct GroupSize {
    uint32_t x = 0, y = 0, z = 0;
};

/// What is demanded of a kernel's subgroups. Group sizes that a constant decides are multiples of
/// Device::subgroup_size(), so that subgroups of that size are full there too.
struct Subgroups {
    bool full = false;
    uint32_t size = 0;  // 0: the driver chooses
};

/// The group size that a shader declares; 0 where a constant decides it.
GroupSize group_size(std::span<const uint32_t> spirv) {
    constexpr uint32_t kOpExecutionMode = 16, kLocalSize = 17, kOpSpecConstantComposite = 51;
    GroupSize size;
    for (size_t at = 5; at < spirv.size();) {
        uint32_t words = spirv[at] >> 16, op = spirv[at] & 0xffff;
        if (words == 0) break;
        if (op == kOpSpecConstantComposite) return {};
        if (op == kOpExecutionMode && words == 6 && at + 6 <= spirv.size() &&
            spirv[at + 2] == kLocalSize)
            size = {spirv[at + 3], spirv[at + 4], spirv[at + 5]};
        at += words;
    }
    return size;
}

Result<Pipeline> make_pipeline(VkDevice device, VkShaderModule module, VkPipelineLayout layout,
                               std::span<const uint32_t> constants, Subgroups subgroups,
                               std::string_view doing) {
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo fixed{};
    fixed.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO;
    fixed.requiredSubgroupSize = subgroups.size;
    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
    VkSpecializationInfo values{};
    values.mapEntryCount = static_cast<uint32_t>(entries.size());
    values.pMapEntries = entries.data();
    values.dataSize = constants.size_bytes();
    values.pData = constants.data();

    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = constants.empty() ? nullptr : &values;
    if (subgroups.size > 0) info.stage.pNext = &fixed;
    if (subgroups.full)
        info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkResult result =
        vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    if (result != VK_SUCCESS) return pipeline_failure(result, doing);
    return Pipeline(device, pipeline);
}

}  // namespace

Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&& other) noexcept {
    Kernel taken(std::move(other));
    std::swap(gpu_, taken.gpu_);
    std::swap(name_, taken.name_);
    std::swap(owned_, taken.owned_);
    std::swap(rate_, taken.rate_);
    return *this;
}
Kernel::~Kernel() {
    if (owned_) gpu_->retire(std::move(owned_));
}

Result<Kernel> Kernel::create(const Gpu& gpu, std::string_view name,
                              std::span<const uint32_t> spirv,
                              std::span<const uint32_t> constants) {
    std::string doing = fmt::format("compiling kernel \"{}\"", name);
    GroupSize size = group_size(spirv);
    uint64_t invocations = uint64_t{size.x} * size.y * size.z;
    if (invocations > gpu->physical().max_group_size) {
        return fail(
            Errc::unsupported,
            fmt::format("kernel \"{}\" has {} invocations in a group; GPU \"{}\" takes {}", name,
                        invocations, gpu->info().name, gpu->physical().max_group_size));
    }
    const PhysicalDevice& physical = gpu->physical();
    Subgroups subgroups;
    subgroups.full = physical.full_subgroups && size.x > 0 && size.x % gpu->subgroup_size() == 0;
    subgroups.size = physical.fixed_subgroups ? gpu->subgroup_size() : 0;
    Kernel kernel;
    kernel.gpu_ = gpu;
    kernel.name_ = name;
    AG_TRY(ShaderModule module, make_module(gpu->get(), spirv, doing));
    kernel.owned_ = std::make_shared<Owned>();
    AG_TRY(kernel.owned_->layout,
           make_layout(gpu->get(), VK_SHADER_STAGE_COMPUTE_BIT, kPushBytes, doing));
    AG_TRY(kernel.owned_->pipeline,
           make_pipeline(gpu->get(), module.get(), kernel.layout(), constants, subgroups, doing));
    kernel.rate_ = std::make_shared<KernelRate>();
    gpu->set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(kernel.pipeline()), name);
    return kernel;
}

}  // namespace aglow::vk
