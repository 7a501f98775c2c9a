// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/messages.h"
#include "aglow/vk/physical_device.h"

#include <memory>
#include <vector>

namespace aglow::vk {

/// The connection to the Vulkan loader, which finds the drivers.
class Instance {
public:
    /// With `messages`, validation and synchronisation validation are on and report there.
    /// Errors  unsupported: no Vulkan driver, or no validation layer where it is asked for.
    static Result<std::unique_ptr<Instance>> create(std::shared_ptr<Messages> messages = nullptr);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    VkInstance get() const { return instance_; }
    bool validates() const { return messages_ != nullptr; }

    /// Best first, as list_gpus() says.
    std::vector<PhysicalDevice> devices() const;

private:
    Instance() = default;
    std::shared_ptr<Messages> messages_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

}  // namespace aglow::vk
