// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/memory_pool.h"

#include "aglow/core/assert.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::vk {

namespace {

constexpr uint64_t kBlockBytes = uint64_t{64} << 20;
constexpr uint64_t kGrain = 256;  // bytes; sizes and offsets are multiples, as addresses shall be

uint64_t round_up(uint64_t bytes, uint64_t step) { return (bytes + step - 1) / step * step; }

// Host memory that the driver caches is slow to write and that it does not cache slow to read.
int score(VkMemoryPropertyFlags flags, Memory memory) {
    bool local = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    bool visible = flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    bool coherent = flags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    bool cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    // Memory that can vanish, is not backed, or is protected serves none of the uses.
    constexpr VkMemoryPropertyFlags kSpecial = VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
                                               VK_MEMORY_PROPERTY_PROTECTED_BIT |
                                               VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD;
    if (flags & kSpecial) return -1;
    if (memory == Memory::device) return (local ? 2 : 0) + (visible ? 0 : 1);
    if (!visible || !coherent) return -1;
    return (local ? 0 : 1) + (cached == (memory == Memory::readback) ? 2 : 0);
}

uint32_t choose_type(const VkPhysicalDeviceMemoryProperties& properties, uint32_t allowed,
                     Memory memory) {
    int best_score = -1;
    uint32_t best = 0;
    for (uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
        if (!(allowed >> i & 1)) continue;
        int its_score = score(properties.memoryTypes[i].propertyFlags, memory);
        if (its_score > best_score) {
            best_score = its_score;
            best = i;
        }
    }
    return best;
}

}  // namespace

struct MemoryBlock {
    uint32_t type = 0;
    bool shared = false;  // by several allocations
    DeviceMemory memory;
    void* mapped = nullptr;
    FreeList ranges;
};

MemoryPool::MemoryPool(VkPhysicalDevice physical, VkDevice device, uint64_t max_allocation_bytes,
                       uint64_t most_bytes)
    : device_(device), max_allocation_bytes_(max_allocation_bytes), most_bytes_(most_bytes) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

MemoryPool::~MemoryPool() { AG_ASSERT(bytes_in_use_ == 0, "buffers die before their device"); }

uint64_t MemoryPool::heap_bytes(uint32_t type) const {
    const uint32_t heap = properties_.memoryTypes[type].heapIndex;
    return std::min(properties_.memoryHeaps[heap].size, most_bytes_);
}

tl::unexpected<Error> MemoryPool::full(const Request& request, uint32_t type) const {
    const VkMemoryType& memory = properties_.memoryTypes[type];
    uint64_t heap = heap_bytes(type);
    return fail(
        Errc::out_of_memory,
        fmt::format("{0} \"{1}\" needs {2} bytes of {3} memory; {4} of {5} are in use, and "
                    "one {0} can have {6}",
                    request.kind, request.name, request.bytes,
                    memory.propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT ? "GPU" : "host",
                    bytes_in_use_, heap, std::min(max_allocation_bytes_, heap)));
}

tl::unexpected<Error> MemoryPool::too_large(uint64_t bytes, std::string_view name) const {
    return fail(Errc::out_of_memory,
                fmt::format("buffer \"{}\" needs {} bytes; this GPU gives one buffer at most {}",
                            name, bytes, max_allocation_bytes_));
}

Result<MemoryBlock*> MemoryPool::add_block(uint64_t bytes, uint32_t type, const Request& request) {
    const VkMemoryType& memory_type = properties_.memoryTypes[type];
    if (bytes > max_allocation_bytes_ || bytes > heap_bytes(type)) return full(request, type);
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.pNext = &flags;
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    if (vkAllocateMemory(device_, &info, nullptr, &memory) != VK_SUCCESS)
        return full(request, type);
    auto block = std::make_unique<MemoryBlock>(
        MemoryBlock{type, false, DeviceMemory(device_, memory), nullptr, FreeList(bytes)});
    bool visible = memory_type.propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    if (visible && vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &block->mapped) != VK_SUCCESS)
        return full(request, type);
    blocks_.push_back(std::move(block));
    return blocks_.back().get();
}

Result<Allocation> MemoryPool::allocate(const VkMemoryRequirements& needs, Memory memory,
                                        std::string_view name, std::string_view kind) {
    uint64_t bytes = round_up(needs.size, kGrain);
    uint64_t alignment = std::max(needs.alignment, kGrain);
    std::lock_guard lock(mutex_);
    uint32_t type = choose_type(properties_, needs.memoryTypeBits, memory);
    if (bytes_in_use_ > most_bytes_ || bytes > most_bytes_ - bytes_in_use_)
        return full({needs.size, name, kind}, type);
    uint64_t block_bytes = std::min(kBlockBytes, heap_bytes(type) / 8);
    bool shared = bytes <= block_bytes / 4;

    MemoryBlock* block = nullptr;
    std::optional<uint64_t> offset;
    for (size_t i = 0; shared && !offset && i < blocks_.size(); ++i) {
        block = blocks_[i].get();
        if (block->shared && block->type == type) offset = block->ranges.allocate(bytes, alignment);
    }
    if (!offset) {
        AG_TRY(block, add_block(shared ? block_bytes : bytes, type, {needs.size, name, kind}));
        block->shared = shared;
        offset = block->ranges.allocate(bytes, alignment);
    }
    bytes_in_use_ += bytes;
    peak_bytes_ = std::max(peak_bytes_, bytes_in_use_);
    void* mapped = nullptr;
    if (block->mapped && memory != Memory::device)
        mapped = static_cast<std::byte*>(block->mapped) + *offset;
    return Allocation{block, block->memory.get(), *offset, bytes, mapped};
}

void MemoryPool::free(const Allocation& allocation) {
    std::lock_guard lock(mutex_);
    MemoryBlock& block = *allocation.block;
    block.ranges.free(allocation.offset, allocation.bytes);
    bytes_in_use_ -= allocation.bytes;
    if (!block.ranges.unused()) return;
    auto idle = [&](const std::unique_ptr<MemoryBlock>& other) {
        return other.get() != &block && other->shared && other->type == block.type &&
               other->ranges.unused();
    };
    if (block.shared && std::none_of(blocks_.begin(), blocks_.end(), idle)) return;
    auto it = std::find_if(blocks_.begin(), blocks_.end(),
                           [&](const auto& other) { return other.get() == &block; });
    blocks_.erase(it);
}

uint64_t MemoryPool::bytes_in_use() const {
    std::lock_guard lock(mutex_);
    return bytes_in_use_;
}

uint64_t MemoryPool::peak_bytes() const {
    std::lock_guard lock(mutex_);
    return peak_bytes_;
}

size_t MemoryPool::block_count() const {
    std::lock_guard lock(mutex_);
    return blocks_.size();
}

}  // namespace aglow::vk
