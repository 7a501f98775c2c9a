// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/instance.h"

#include "aglow/vk/failure.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace aglow::vk {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* messages) {
    static_cast<Messages*>(messages)->add(data->pMessage ? data->pMessage : "");
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Messages* messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // What the loader says of drivers that it skips is of type "general" and no mistake of ours.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = keep_message;
    info.pUserData = messages;
    return info;
}

bool has_validation_layer() {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
}

}  // namespace

Result<std::unique_ptr<Instance>> Instance::create(std::shared_ptr<Messages> messages) {
    if (messages && !has_validation_layer()) {
        return fail(Errc::unsupported,
                    "Vulkan's validation layer is asked for and not installed; install "
                    "vulkan-validationlayers");
    }
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "Aglow";
    application.apiVersion = VK_API_VERSION_1_3;

    std::array checks{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT listen = messenger_info(messages.get());
    VkValidationFeaturesEXT validation{};
    validation.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    validation.pNext = &listen;
    validation.enabledValidationFeatureCount = static_cast<uint32_t>(checks.size());
    validation.pEnabledValidationFeatures = checks.data();

    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (messages) {
        info.pNext = &validation;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    std::unique_ptr<Instance> instance(new Instance);
    VkResult result = vkCreateInstance(&info, nullptr, &instance->instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return fail(Errc::unsupported,
                    "there is no Vulkan driver; install one (mesa-vulkan-drivers has one that "
                    "needs no graphics card)");
    }
    if (result != VK_SUCCESS) return failure(result, "starting Vulkan");
    if (messages) {
        auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance->instance_, "vkCreateDebugUtilsMessengerEXT"));
        result = create(instance->instance_, &listen, nullptr, &instance->messenger_);
        if (result != VK_SUCCESS) return failure(result, "listening to the validation layer");
    }
    instance->messages_ = std::move(messages);
    return instance;
}

Instance::~Instance() {
    if (messenger_) {
        auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

std::vector<PhysicalDevice> Instance::devices() const {
    uint32_t count = 0;
    if (vkEnumeratePhysicalDevices(instance_, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkPhysicalDevice> handles(count);
    if (vkEnumeratePhysicalDevices(instance_, &count, handles.data()) < VK_SUCCESS) return {};
    handles.resize(count);
    std::vector<PhysicalDevice> devices;
    for (VkPhysicalDevice handle : handles) devices.push_back(examine(handle));
    std::stable_sort(devices.begin(), devices.end(), better);
    return devices;
}

}  // namespace aglow::vk
