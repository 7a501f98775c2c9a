// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/handle.h"
#include "aglow/vk/memory_pool.h"

#include <cstdint>

namespace aglow::vk {

/// A range of device memory. Move only; gives its memory back when it dies, which must be after the
/// last work on it has finished.
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

    uint64_t size() const { return size_; }              ///< bytes
    uint64_t address() const { return address_; }        ///< multiple of 256
    void* mapped() const { return allocation_.mapped; }  ///< null for Memory::device
    VkBuffer get() const { return buffer_.get(); }

private:
    friend class Device;
    void swap(Buffer& other) noexcept;

    MemoryPool* pool_ = nullptr;
    Allocation allocation_;
    BufferHandle buffer_;
    uint64_t size_ = 0;
    uint64_t address_ = 0;
};

}  // namespace aglow::vk
