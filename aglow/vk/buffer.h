// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/handle.h"
#include "aglow/vk/memory_pool.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace aglow::vk {

class Device;

/// A range of device memory. Move only. When it dies its memory goes back as soon as all work that
/// was submitted has finished; it must not die between being recorded in a stream and the submit.
class Buffer {
public:
    Buffer() = default;  ///< no memory: size 0, address 0
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        Buffer taken(std::move(other));
        swap(taken);
        return *this;
    }
    ~Buffer();

    uint64_t size() const { return size_; }        ///< bytes
    uint64_t address() const { return address_; }  ///< multiple of 256
    void* mapped() const { return mapped_; }       ///< null for Memory::device
    VkBuffer get() const { return handle_; }

private:
    friend class Device;
    struct Owned {
        ~Owned();
        MemoryPool* pool = nullptr;
        Allocation allocation;
        BufferHandle buffer;
    };
    void swap(Buffer& other) noexcept;

    Device* device_ = nullptr;
    std::shared_ptr<Owned> owned_;
    VkBuffer handle_ = VK_NULL_HANDLE;
    uint64_t size_ = 0;
    uint64_t address_ = 0;
    void* mapped_ = nullptr;
};

}  // namespace aglow::vk
