// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/device.h"

#include "aglow/vk/failure.h"
#include "aglow/vk/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <type_traits>
#include <utility>

namespace aglow::vk {

namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

std::string names_of(const std::vector<PhysicalDevice>& devices) {
    std::string names;
    for (const PhysicalDevice& device : devices)
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", device.info.name);
    return names;
}

Result<PhysicalDevice> choose(const std::vector<PhysicalDevice>& devices, const std::string& name) {
    if (devices.empty()) {
        return fail(Errc::unsupported,
                    "Vulkan offers no device; install a driver (mesa-vulkan-drivers has one that "
                    "needs no graphics card)");
    }
    auto named = [&](const PhysicalDevice& device) {
        return lower(device.info.name).find(lower(name)) != std::string::npos;
    };
    auto found = std::find_if(devices.begin(), devices.end(), named);
    if (found == devices.end()) {
        return fail(Errc::unsupported,
                    fmt::format("no GPU is called \"{}\"; there is {}", name, names_of(devices)));
    }
    if (!found->info.missing.empty()) {
        return fail(Errc::unsupported,
                    fmt::format("GPU \"{}\" lacks {}; a newer driver may have it", found->info.name,
                                found->info.missing));
    }
    return *found;
}

/// Names of the extensions that the device is opened with.
std::vector<const char*> extensions_of(const PhysicalDevice& physical) {
    std::vector<const char*> names;
    if (physical.full_subgroups_extension)
        names.push_back(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME);
    if (physical.drawing.rendering_extension)
        names.push_back(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    if (physical.drawing.transform_feedback)
        names.push_back(VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME);
    if (physical.drawing.mesh_shader) names.push_back(VK_EXT_MESH_SHADER_EXTENSION_NAME);
    return names;
}

Result<VkDevice> create_device(const PhysicalDevice& physical) {
    VkPhysicalDeviceDynamicRenderingFeatures rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES;
    rendering.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback{};
    feedback.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT;
    feedback.transformFeedback = VK_TRUE;
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    mesh.meshShader = VK_TRUE;
    VkPhysicalDeviceSubgroupSizeControlFeatures subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES;
    subgroups.subgroupSizeControl = VK_TRUE;
    subgroups.computeFullSubgroups = VK_TRUE;
    VkPhysicalDeviceVulkan12Features features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features.bufferDeviceAddress = VK_TRUE;
    features.scalarBlockLayout = VK_TRUE;
    features.timelineSemaphore = VK_TRUE;
    features.hostQueryReset = VK_TRUE;
    VkPhysicalDeviceFeatures2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    all.pNext = &features;
    all.features.shaderInt64 = physical.int64;
    const DrawingFeatures& drawing = physical.drawing;
    all.features.geometryShader = drawing.geometry_shader;
    all.features.tessellationShader = drawing.tessellation_shader;
    all.features.vertexPipelineStoresAndAtomics = drawing.shader_stores;
    all.features.fragmentStoresAndAtomics = drawing.shader_stores;
    all.features.sampleRateShading = drawing.sample_shading;
    all.features.fillModeNonSolid = drawing.lines;
    auto add = [&](bool wanted, auto& more) {
        if (wanted) more.pNext = std::exchange(features.pNext, &more);
    };
    add(physical.full_subgroups, subgroups);
    add(drawing.draws, rendering);
    add(drawing.transform_feedback, feedback);
    add(drawing.mesh_shader, mesh);

    float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = physical.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    std::vector<const char*> extensions = extensions_of(physical);
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &all;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    VkResult result = vkCreateDevice(physical.handle, &info, nullptr, &device);
    if (result != VK_SUCCESS)
        return failure(result, fmt::format("opening GPU \"{}\"", physical.info.name));
    return device;
}

}  // namespace

Result<Gpu> Device::open(const DeviceOptions& options) {
    Gpu gpu(new Device);
    AG_CHECK(gpu->open_device(options));
    return gpu;
}

Status Device::open_device(const DeviceOptions& options) {
    if (options.validate) {
        messages_ = options.messages ? options.messages : std::make_shared<Messages>();
    }
    AG_TRY(instance_, Instance::create(messages_));
    AG_TRY(physical_, choose(instance_->devices(), options.name));
    if (!options.drawing) physical_.drawing = {};
    AG_TRY(device_, create_device(physical_));
    load_drawing();
    if (!options.timestamps) physical_.timestamp_period = 0;
    if (messages_) {
        set_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
    }
    pool_ = std::make_unique<MemoryPool>(physical_.handle, device_, physical_.max_allocation_bytes,
                                         options.faults.memory_bytes);
    faults_ = options.faults;
    return make_queue();
}

void Device::load_drawing() {
    const DrawingFeatures& has = physical_.drawing;
    auto load = [&](bool wanted, auto& command, const char* name) {
        if (!wanted) return;
        command = reinterpret_cast<std::remove_reference_t<decltype(command)>>(
            vkGetDeviceProcAddr(device_, name));
    };
    bool extension = has.rendering_extension;
    load(has.draws, drawing_.begin, extension ? "vkCmdBeginRenderingKHR" : "vkCmdBeginRendering");
    load(has.draws, drawing_.end, extension ? "vkCmdEndRenderingKHR" : "vkCmdEndRendering");
    bool captures = has.transform_feedback;
    load(captures, drawing_.bind_capture, "vkCmdBindTransformFeedbackBuffersEXT");
    load(captures, drawing_.begin_capture, "vkCmdBeginTransformFeedbackEXT");
    load(captures, drawing_.end_capture, "vkCmdEndTransformFeedbackEXT");
    load(has.mesh_shader, drawing_.draw_groups, "vkCmdDrawMeshTasksEXT");
}

Status Device::check_drawing() const {
    if (physical_.drawing.draws) return {};
    return fail(Errc::unsupported,
                fmt::format("GPU \"{}\" computes but cannot draw: it lacks a graphics queue or "
                            "dynamic rendering; a newer driver may have them, and engine rays "
                            "needs neither",
                            info().name));
}

Status Device::make_queue() {
    vkGetDeviceQueue(device_, physical_.queue_family, 0, &queue_);
    VkSemaphoreTypeCreateInfo timeline{};
    timeline.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
    timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    info.pNext = &timeline;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    VkResult result = vkCreateSemaphore(device_, &info, nullptr, &semaphore);
    if (result != VK_SUCCESS) return failure(result, "opening the GPU");
    finished_ = Semaphore(device_, semaphore);
    return {};
}

Device::~Device() {
    // Streams wait for their work before they let go of the device, so nothing runs any more.
    retired_.clear();
    finished_ = {};
    pool_.reset();
    if (device_) vkDestroyDevice(device_, nullptr);
}

Result<Buffer> Device::make_buffer(uint64_t bytes, std::string_view name, Memory memory) {
    bytes = std::max<uint64_t>(bytes, 4);
    if (allocation_count_++ == faults_.fail_allocation) {
        return fail(Errc::out_of_memory,
                    fmt::format("buffer \"{}\" needs {} bytes of GPU memory, and tests ask that "
                                "there is none; {} are in use",
                                name, bytes, bytes_in_use()));
    }
    reap();
    if (bytes > physical_.max_allocation_bytes) return pool_->too_large(bytes, name);
    const std::string doing = fmt::format("making buffer \"{}\" of {} bytes", name, bytes);
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (physical_.drawing.transform_feedback)
        info.usage |= VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT;
    VkBuffer handle = VK_NULL_HANDLE;
    VkResult result = vkCreateBuffer(device_, &info, nullptr, &handle);
    if (result != VK_SUCCESS) return failure(result, doing);
    auto owned = std::make_shared<Buffer::Owned>();
    owned->pool = pool_.get();
    owned->buffer = BufferHandle(device_, handle);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, handle, &needs);
    AG_TRY(owned->allocation, pool_->allocate(needs, memory, name));
    const Allocation& place = owned->allocation;
    result = vkBindBufferMemory(device_, handle, place.memory, place.offset);
    if (result != VK_SUCCESS) return failure(result, doing);
    set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle), name);

    Buffer buffer;
    buffer.device_ = this;
    buffer.handle_ = handle;
    buffer.size_ = bytes;
    buffer.mapped_ = place.mapped;
    VkBufferDeviceAddressInfo whose{};
    whose.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    whose.buffer = handle;
    buffer.address_ = vkGetBufferDeviceAddress(device_, &whose);
    buffer.owned_ = std::move(owned);
    return buffer;
}

Status Device::grow(Buffer& buffer, uint64_t bytes, std::string_view name) {
    const bool had_any = buffer.address() != 0;
    if (had_any && bytes <= buffer.size()) return {};
    buffer = {};
    const uint64_t most = std::max(bytes, physical_.max_allocation_bytes);
    AG_TRY(buffer, make_buffer(had_any ? std::min(bytes + bytes / 4, most) : bytes, name));
    return {};
}

void Device::set_name(VkObjectType type, uint64_t object, std::string_view name) const {
    if (!set_name_) return;
    std::string text(name);
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = text.c_str();
    set_name_(device_, &info);
}

tl::unexpected<Error> Device::lost(std::string_view what) {
    lost_ = true;
    return failure(VK_ERROR_DEVICE_LOST, fmt::format("\"{}\" ran {}", info().name, what));
}

Result<uint64_t> Device::submit(VkCommandBuffer commands, std::string_view what) {
    std::lock_guard lock(queue_mutex_);
    bool injected = faults_.lose_at_submit >= 0 && submit_count_ >= faults_.lose_at_submit;
    ++submit_count_;
    if (lost_ || injected) return lost(what);

    uint64_t ticket = last_ticket_ + 1;
    VkSemaphore done = finished_.get();
    VkTimelineSemaphoreSubmitInfo values{};
    values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
    values.signalSemaphoreValueCount = 1;
    values.pSignalSemaphoreValues = &ticket;
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.pNext = &values;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    info.signalSemaphoreCount = 1;
    info.pSignalSemaphores = &done;
    VkResult result = vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE);
    if (result == VK_ERROR_DEVICE_LOST) return lost(what);
    if (result != VK_SUCCESS) return failure(result, fmt::format("submitting {}", what));
    last_ticket_ = ticket;
    return ticket;
}

Status Device::wait(uint64_t ticket, std::string_view what) {
    VkSemaphore semaphore = finished_.get();
    VkSemaphoreWaitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
    info.semaphoreCount = 1;
    info.pSemaphores = &semaphore;
    info.pValues = &ticket;
    VkResult result = vkWaitSemaphores(device_, &info, UINT64_MAX);
    if (result == VK_ERROR_DEVICE_LOST) return lost(what);
    if (result != VK_SUCCESS) return failure(result, fmt::format("waiting for {}", what));
    reap();
    return {};
}

void Device::retire(std::shared_ptr<void> object) {
    {
        std::lock_guard lock(retired_mutex_);
        retired_.push_back({last_ticket_, std::move(object)});
    }
    reap();
}

void Device::reap() const {
    std::deque<Retired> unused;  // dies after the lock
    std::lock_guard lock(retired_mutex_);
    if (retired_.empty()) return;
    uint64_t finished = 0;
    if (vkGetSemaphoreCounterValue(device_, finished_.get(), &finished) != VK_SUCCESS) return;
    while (!retired_.empty() && retired_.front().ticket <= finished) {
        unused.push_back(std::move(retired_.front()));
        retired_.pop_front();
    }
}

uint64_t Device::bytes_in_use() const {
    reap();
    return pool_->bytes_in_use();
}

uint64_t Device::peak_bytes() const { return pool_->peak_bytes(); }
int Device::allocation_count() const { return allocation_count_; }

int Device::submit_count() const {
    std::lock_guard lock(queue_mutex_);
    return submit_count_;
}

std::vector<std::string> Device::messages() const {
    return messages_ ? messages_->list() : std::vector<std::string>{};
}

}  // namespace aglow::vk
