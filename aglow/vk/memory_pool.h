// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/free_list.h"
#include "aglow/vk/handle.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

namespace aglow::vk {

enum class Memory : uint8_t {
    device,   ///< fast for the device; filled and read through a Stream
    upload,   ///< mapped; written by the host, read by the device
    readback  ///< mapped and cached; written by the device, read by the host
};

struct MemoryBlock;

/// Part of a block of device memory.
struct Allocation {
    MemoryBlock* block = nullptr;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t offset = 0, bytes = 0;  ///< in the block
    void* mapped = nullptr;          ///< where host memory begins, null for Memory::device
};

/// Device memory in blocks of 64 MiB for each type of memory; what needs more than a quarter of a
/// block gets one of its own. A block without use goes back, but for one of each type.
/// Thread safety  all members may be called from any thread.
class MemoryPool {
public:
    /// One allocation has `max_allocation_bytes` at most, and all together have `most_bytes`.
    MemoryPool(VkPhysicalDevice physical, VkDevice device, uint64_t max_allocation_bytes,
               uint64_t most_bytes = UINT64_MAX);
    ~MemoryPool();

    /// `kind` is what the memory is for, "buffer" or "image".
    /// Errors  out_of_memory; `name` and the memory asked for, in use and in the heap are named.
    Result<Allocation> allocate(const VkMemoryRequirements& needs, Memory memory,
                                std::string_view name, std::string_view kind = "buffer");
    void free(const Allocation& allocation);
    /// The error of a buffer that no single piece of memory can hold.
    tl::unexpected<Error> too_large(uint64_t bytes, std::string_view name) const;

    uint64_t bytes_in_use() const;
    uint64_t peak_bytes() const;
    size_t block_count() const;  ///< pieces of memory that the driver gave

private:
    struct Request {
        uint64_t bytes = 0;
        std::string_view name, kind;
    };
    tl::unexpected<Error> full(const Request& request, uint32_t type) const;
    uint64_t heap_bytes(uint32_t type) const;
    Result<MemoryBlock*> add_block(uint64_t bytes, uint32_t type, const Request& request);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_;
    uint64_t max_allocation_bytes_, most_bytes_;
    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<MemoryBlock>> blocks_;
    uint64_t bytes_in_use_ = 0;
    uint64_t peak_bytes_ = 0;
};

}  // namespace aglow::vk
