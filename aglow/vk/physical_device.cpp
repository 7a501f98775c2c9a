// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/physical_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

namespace aglow::vk {

namespace {

constexpr uint32_t kSharedBytes = 32768;  // of a group; the largest that a kernel declares
constexpr uint32_t kGroupSize = 256;      // invocations; the most that a kernel declares

GpuKind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return GpuKind::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return GpuKind::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return GpuKind::software;
        default:
            return GpuKind::virtual_gpu;
    }
}

class Extensions {
public:
    explicit Extensions(VkPhysicalDevice device) {
        uint32_t count = 0;
        vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
        extensions_.resize(count);
        vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions_.data());
    }
    bool has(std::string_view name) const {
        return std::any_of(extensions_.begin(), extensions_.end(),
                           [&](const auto& extension) { return name == extension.extensionName; });
    }

private:
    std::vector<VkExtensionProperties> extensions_;
};

uint64_t largest_local_heap(VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    uint64_t largest = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        const VkMemoryHeap& heap = memory.memoryHeaps[i];
        if (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) largest = std::max(largest, heap.size);
    }
    return largest;
}

// A family that draws too is as good for computing and leaves the way to drawing open.
std::optional<uint32_t> choose_family(const std::vector<VkQueueFamilyProperties>& families) {
    std::optional<uint32_t> chosen;
    for (uint32_t i = 0; i < families.size(); ++i) {
        VkQueueFlags flags = families[i].queueFlags;
        if (!(flags & VK_QUEUE_COMPUTE_BIT)) continue;
        if (flags & VK_QUEUE_GRAPHICS_BIT) return i;
        if (!chosen) chosen = i;
    }
    return chosen;
}

void examine_queues(PhysicalDevice& device, float period, std::vector<std::string>& missing) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
    std::optional<uint32_t> family = choose_family(families);
    if (!family) {
        missing.push_back("a queue that computes");
        return;
    }
    device.queue_family = *family;
    device.drawing.draws = families[*family].queueFlags & VK_QUEUE_GRAPHICS_BIT;
    uint32_t bits = families[*family].timestampValidBits;
    if (bits == 0) return;
    device.timestamp_period = period;
    device.timestamp_mask = bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
}

void require(bool has, const char* what, std::vector<std::string>& missing) {
    if (!has) missing.push_back(what);
}

void examine_properties(PhysicalDevice& device, std::vector<std::string>& missing) {
    VkPhysicalDeviceMaintenance3Properties sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    VkPhysicalDeviceSubgroupProperties subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    subgroups.pNext = &sizes;
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    driver.pNext = &subgroups;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &driver;
    vkGetPhysicalDeviceProperties2(device.handle, &all);

    const VkPhysicalDeviceLimits& limits = all.properties.limits;
    device.info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    device.info.subgroup_size = subgroups.subgroupSize;
    device.max_allocation_bytes = sizes.maxMemoryAllocationSize;
    device.max_group_size = limits.maxComputeWorkGroupInvocations;
    device.drawing.granularity = limits.bufferImageGranularity;
    require(limits.maxComputeSharedMemorySize >= kSharedBytes, "32 KiB of shared memory", missing);
    require(limits.maxComputeWorkGroupInvocations >= kGroupSize, "groups of 256 invocations",
            missing);

    constexpr VkSubgroupFeatureFlags kOperations =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
        VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
        VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    bool operations = (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                      (subgroups.supportedOperations & kOperations) == kOperations;
    require(operations, "subgroup vote, arithmetic, ballot and shuffle in compute", missing);
    examine_queues(device, limits.timestampPeriod, missing);
}

/// Can a kernel demand subgroups of the size that the device reports?
bool can_fix_subgroups(VkPhysicalDevice handle) {
    VkPhysicalDeviceSubgroupSizeControlProperties sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &sizes;
    vkGetPhysicalDeviceProperties2(handle, &all);
    return sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT;
}

/// The queue's part of drawing.draws is known before.
void examine_drawing(PhysicalDevice& device, bool version_1_3, const Extensions& extensions) {
    bool rendering_extension = extensions.has(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    VkPhysicalDeviceDynamicRenderingFeatures rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES;
    VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback{};
    feedback.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT;
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    VkPhysicalDeviceFeatures2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    auto ask = [&](bool known, auto& features) {
        if (known) features.pNext = std::exchange(all.pNext, &features);
    };
    ask(version_1_3 || rendering_extension, rendering);
    ask(extensions.has(VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME), feedback);
    ask(extensions.has(VK_EXT_MESH_SHADER_EXTENSION_NAME), mesh);
    vkGetPhysicalDeviceFeatures2(device.handle, &all);

    DrawingFeatures& drawing = device.drawing;
    drawing.draws = drawing.draws && rendering.dynamicRendering;
    if (!drawing.draws) return;
    drawing.rendering_extension = !version_1_3;
    drawing.geometry_shader = all.features.geometryShader;
    drawing.tessellation_shader = all.features.tessellationShader;
    drawing.transform_feedback = feedback.transformFeedback && drawing.geometry_shader;
    drawing.mesh_shader = mesh.meshShader;
    drawing.shader_stores =
        all.features.vertexPipelineStoresAndAtomics && all.features.fragmentStoresAndAtomics;
    drawing.sample_shading = all.features.sampleRateShading;
    drawing.lines = all.features.fillModeNonSolid;
}

void examine_features(PhysicalDevice& device, bool version_1_3, std::vector<std::string>& missing) {
    const Extensions extensions(device.handle);
    auto has = [&](const char* name) { return extensions.has(name); };
    examine_drawing(device, version_1_3, extensions);
    bool sizes_extension = has(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME);

    VkPhysicalDeviceSubgroupSizeControlFeatures subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES;
    VkPhysicalDeviceVulkan12Features features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    if (version_1_3 || sizes_extension) features.pNext = &subgroups;
    VkPhysicalDeviceFeatures2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    all.pNext = &features;
    vkGetPhysicalDeviceFeatures2(device.handle, &all);

    require(features.bufferDeviceAddress, "buffer device addresses", missing);
    require(features.scalarBlockLayout, "scalar block layout", missing);
    require(features.timelineSemaphore, "timeline semaphores", missing);
    require(features.hostQueryReset, "query reset by the host", missing);
    require(all.features.shaderInt64, "64-bit integers in shaders", missing);

    device.full_subgroups = subgroups.subgroupSizeControl && subgroups.computeFullSubgroups;
    device.full_subgroups_extension = device.full_subgroups && !version_1_3;
    device.fixed_subgroups = device.full_subgroups && can_fix_subgroups(device.handle);
    device.int64 = all.features.shaderInt64;
    auto offer = [&](bool offered, const char* name) {
        if (offered) device.info.features.push_back(name);
    };
    offer(has(VK_KHR_RAY_QUERY_EXTENSION_NAME), "ray query");
    offer(device.drawing.draws, "drawing");
    offer(device.drawing.mesh_shader, "mesh shader");
    offer(device.drawing.geometry_shader, "geometry shader");
    offer(device.drawing.tessellation_shader, "tessellation shader");
    offer(device.drawing.transform_feedback, "transform feedback");
    offer(has(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME), "float atomics");
    offer(features.descriptorIndexing, "descriptor indexing");
    offer(device.full_subgroups, "subgroup size control");
    offer(device.int64, "64-bit integers");
    offer(device.timestamp_period > 0, "timestamps");
}

}  // namespace

PhysicalDevice examine(VkPhysicalDevice handle) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(handle, &properties);
    uint32_t version = properties.apiVersion;

    PhysicalDevice device;
    device.handle = handle;
    device.info.name = properties.deviceName;
    device.info.kind = kind_of(properties.deviceType);
    device.info.memory_bytes = largest_local_heap(handle);
    device.info.api = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version),
                                  VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
    std::vector<std::string> missing;
    if (version < VK_API_VERSION_1_2) {
        missing.push_back("Vulkan 1.2");
    } else {
        examine_properties(device, missing);
        examine_features(device, version >= VK_API_VERSION_1_3, missing);
    }
    device.info.missing = fmt::format("{}", fmt::join(missing, ", "));
    return device;
}

bool better(const PhysicalDevice& a, const PhysicalDevice& b) {
    auto rank = [](const PhysicalDevice& device) {
        return std::tuple(!device.info.missing.empty(), device.info.kind,
                          ~device.info.memory_bytes);
    };
    return rank(a) < rank(b);
}

}  // namespace aglow::vk
