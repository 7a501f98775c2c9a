// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/devices.h"

#include "aglow/vk/device.h"
#include "aglow/vk/instance.h"

namespace aglow {

std::vector<GpuInfo> list_gpus() {
    auto instance = vk::Instance::create();
    if (!instance) return {};
    std::vector<GpuInfo> list;
    for (vk::PhysicalDevice& device : (*instance)->devices())
        list.push_back(std::move(device.info));
    return list;
}

Result<Gpu> open_gpu(std::string_view name) {
    vk::DeviceOptions options;
    options.name = name;
    return vk::Device::open(options);
}

const GpuInfo& info(const vk::Device& device) { return device.info(); }

}  // namespace aglow
