// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace aglow {

namespace vk {
class Device;
}

enum class GpuKind : uint8_t { discrete, integrated, virtual_gpu, software };

/// One Vulkan device, and whether Aglow can compute on it.
struct GpuInfo {
    std::string name;
    std::string driver;  ///< name and version
    std::string api;     ///< Vulkan version, "1.3.230"
    GpuKind kind = GpuKind::software;
    uint64_t memory_bytes = 0;  ///< of its largest device-local heap
    uint32_t subgroup_size = 0;
    std::vector<std::string> features;  ///< optional ones it has: "ray query", "mesh shader", ...
    std::string missing;                ///< what Aglow needs and it lacks; empty: usable
};

/// All Vulkan devices, best first: usable before unusable, discrete, integrated, virtual, software,
/// then by memory. Empty where there is no Vulkan driver.
std::vector<GpuInfo> list_gpus();

/// A device to compute on, shared by all that is made with it.
using Gpu = std::shared_ptr<vk::Device>;

/// Opens the best usable device whose name contains `name` (any case); with an empty name the best
/// hardware, or a software device where there is nothing else.
/// Errors  unsupported   no such device, or it lacks something; names the devices there are
///         device_lost   the driver failed
Result<Gpu> open_gpu(std::string_view name = {});

const GpuInfo& info(const vk::Device& device);

}  // namespace aglow
