// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/buffer.h"

namespace aglow::vk {

void Buffer::swap(Buffer& other) noexcept {
    std::swap(pool_, other.pool_);
    std::swap(allocation_, other.allocation_);
    std::swap(buffer_, other.buffer_);
    std::swap(size_, other.size_);
    std::swap(address_, other.address_);
}

Buffer::~Buffer() {
    buffer_ = {};  // before the memory that it is bound to
    if (allocation_.block) pool_->free(allocation_);
}

}  // namespace aglow::vk
