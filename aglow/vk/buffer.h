// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/handle.h"

#include <cstdint>

namespace aglow::vk {

enum class Memory : uint8_t {
    device,   ///< fast for the device; filled and read through a Stream
    upload,   ///< mapped; written by the host, read by the device
    readback  ///< mapped and cached; written by the device, read by the host
};

/// A range of device memory. Move only; gives its memory back when it dies, which must be after the
/// last work on it has finished.
class Buffer {
public:
    Buffer() = default;  ///< no memory: size 0, address 0
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();

    uint64_t size() const { return size_; }        ///< bytes
    uint64_t address() const { return address_; }  ///< multiple of 256
    void* mapped() const { return mapped_; }       ///< null for Memory::device
    VkBuffer get() const { return buffer_.get(); }

private:
    // ... to be filled in
    BufferHandle buffer_;
    uint64_t size_ = 0;
    uint64_t address_ = 0;
    void* mapped_ = nullptr;
};

}  // namespace aglow::vk
