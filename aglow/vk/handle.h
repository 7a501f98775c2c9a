// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vulkan/vulkan.h>

#include <utility>

namespace aglow::vk {

/// Sole owner of one Vulkan object that is destroyed through its VkDevice. Move only.
template <class T, void (*Destroy)(VkDevice, T, const VkAllocationCallbacks*)>
class Handle {
public:
    Handle() = default;
    Handle(VkDevice device, T object) : device_(device), object_(object) {}
    Handle(Handle&& other) noexcept
        : device_(other.device_), object_(std::exchange(other.object_, T{})) {}
    Handle& operator=(Handle&& other) noexcept {
        Handle taken(std::move(other));  // what this held dies with it, before the caller goes on
        std::swap(device_, taken.device_);
        std::swap(object_, taken.object_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (object_) Destroy(device_, object_, nullptr);
    }
    T get() const { return object_; }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    T object_{};
};

using BufferHandle = Handle<VkBuffer, vkDestroyBuffer>;
using CommandPool = Handle<VkCommandPool, vkDestroyCommandPool>;
using DeviceMemory = Handle<VkDeviceMemory, vkFreeMemory>;
using ImageHandle = Handle<VkImage, vkDestroyImage>;
using ImageView = Handle<VkImageView, vkDestroyImageView>;
using Pipeline = Handle<VkPipeline, vkDestroyPipeline>;
using PipelineLayout = Handle<VkPipelineLayout, vkDestroyPipelineLayout>;
using QueryPool = Handle<VkQueryPool, vkDestroyQueryPool>;
using Semaphore = Handle<VkSemaphore, vkDestroySemaphore>;
using ShaderModule = Handle<VkShaderModule, vkDestroyShaderModule>;

}  // namespace aglow::vk
