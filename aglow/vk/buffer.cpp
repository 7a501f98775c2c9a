// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/buffer.h"

#include "aglow/vk/device.h"

namespace aglow::vk {

Buffer::Owned::~Owned() {
    buffer = {};  // before the memory that it is bound to
    if (allocation.block) pool->free(allocation);
}

Buffer::~Buffer() {
    if (owned_) device_->retire(std::move(owned_));
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(owned_, other.owned_);
    std::swap(handle_, other.handle_);
    std::swap(size_, other.size_);
    std::swap(address_, other.address_);
    std::swap(mapped_, other.mapped_);
}

}  // namespace aglow::vk
