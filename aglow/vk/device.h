// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/buffer.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/image.h"
#include "aglow/vk/messages.h"
#include "aglow/vk/physical_device.h"

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::vk {

class Instance;

/// Failures that tests ask for. Counts start at 0; -1: never.
struct Faults {
    int fail_allocation = -1;            ///< this buffer or image cannot be had: out of memory
    int lose_at_submit = -1;             ///< this submit and all that follow: the device is lost
    uint64_t memory_bytes = UINT64_MAX;  ///< all buffers and images together have no more than this
};

struct DeviceOptions {
    std::string name;       ///< part of the device's name; see open_gpu()
    bool validate = false;  ///< validation and synchronisation validation; see messages()
    /// Where the messages go; one of its own if null. Keep it to hear what leaks.
    std::shared_ptr<Messages> messages = nullptr;
    bool timestamps = true;  ///< false: do as on a queue that has none
    bool drawing = true;     ///< false: do as on a device that only computes
    Faults faults = {};
};

/// Commands for drawing that drivers offer as extensions; null where they are missing.
struct DrawingCommands {
    PFN_vkCmdBeginRendering begin = nullptr;
    PFN_vkCmdEndRendering end = nullptr;
    PFN_vkCmdBindTransformFeedbackBuffersEXT bind_capture = nullptr;
    PFN_vkCmdBeginTransformFeedbackEXT begin_capture = nullptr;
    PFN_vkCmdEndTransformFeedbackEXT end_capture = nullptr;
    PFN_vkCmdDrawMeshTasksEXT draw_groups = nullptr;
};

/// One Vulkan device with one queue, which computes, and draws where the device can. Outlives
/// everything that is made from it: makers keep the Gpu they were given, or are kept by something
/// that does. Thread safety  all members may be called from any thread.
class Device {
public:
    static Result<Gpu> open(const DeviceOptions& options);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();

    VkDevice get() const { return device_; }
    const GpuInfo& info() const { return physical_.info; }
    const PhysicalDevice& physical() const { return physical_; }
    uint32_t subgroup_size() const { return physical_.info.subgroup_size; }
    /// Length of one step of a timestamp, ns; 0: the queue has no timestamps.
    float timestamp_period() const { return physical_.timestamp_period; }

    /// Memory of `bytes` (at least 4 are given) that shaders reach by its address. `name` appears
    /// in errors and in the driver's tools.
    /// Errors  out_of_memory; names the buffer, the bytes asked for and those in use.
    Result<Buffer> make_buffer(uint64_t bytes, std::string_view name,
                               Memory memory = Memory::device);
    /// Gives `buffer` at least `bytes` bytes of device memory: keeps what it has where that will
    /// do, else drops it, and takes a quarter more if there was any, so that what grows slowly does
    /// not ask each time. What was in it is then lost; as when a buffer dies, nothing that is
    /// recorded and not submitted yet may use it. Errors  as make_buffer(); the buffer is then
    /// empty.
    Status grow(Buffer& buffer, uint64_t bytes, std::string_view name);

    /// An image to draw into. `name` as above.
    /// Errors  out_of_memory, unsupported (the device cannot draw into such images).
    Result<Image> make_image(const ImageOptions& options, std::string_view name);

    /// Errors  unsupported: the device only computes.
    Status check_drawing() const;
    const DrawingCommands& drawing() const { return drawing_; }

    /// Bytes of all buffers and images alive, and the most there have been.
    uint64_t bytes_in_use() const;
    uint64_t peak_bytes() const;

    /// Hands work to the queue, behind all that was submitted before.
    /// Result  a ticket for wait(). Tickets grow, and work finishes in their order.
    /// Errors  device_lost, out_of_memory; `what` names the pass.
    Result<uint64_t> submit(VkCommandBuffer commands, std::string_view what);
    /// Waits until the work of this ticket and all before it has finished.
    /// Errors  device_lost; `what` names the pass.
    Status wait(uint64_t ticket, std::string_view what);
    /// Lets go of `object` as soon as all that is submitted so far has finished.
    void retire(std::shared_ptr<void> object);

    /// Gives an object a name in the driver's tools and in messages().
    void set_name(VkObjectType type, uint64_t object, std::string_view name) const;

    /// How many buffers and images were asked for and how often work was submitted: the range of
    /// Faults.
    int allocation_count() const;
    int submit_count() const;

    /// What the validation layers said so far; tests demand that it is nothing.
    std::vector<std::string> messages() const;

private:
    Device() = default;
    Status open_device(const DeviceOptions& options);
    Status make_queue();
    void load_drawing();
    tl::unexpected<Error> lost(std::string_view what);
    void reap() const;

    std::shared_ptr<Messages> messages_;
    std::unique_ptr<Instance> instance_;
    PhysicalDevice physical_;
    VkDevice device_ = VK_NULL_HANDLE;
    PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
    DrawingCommands drawing_;
    std::unique_ptr<MemoryPool> pool_;
    Faults faults_;
    std::atomic<int> allocation_count_ = 0;
    std::atomic<bool> lost_ = false;

    mutable std::mutex queue_mutex_;  // of queue_ and submit_count_
    VkQueue queue_ = VK_NULL_HANDLE;
    int submit_count_ = 0;
    Semaphore finished_;                     // counts tickets
    std::atomic<uint64_t> last_ticket_ = 0;  // handed out

    struct Retired {
        uint64_t ticket = 0;
        std::shared_ptr<void> object;
    };
    mutable std::mutex retired_mutex_;
    mutable std::deque<Retired> retired_;  // tickets grow
};

}  // namespace aglow::vk
