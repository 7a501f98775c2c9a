// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

namespace aglow::vk {

/// Hands out ranges of a ring of `bytes` bytes in order, and takes them back in the same order.
class StagingRing {
public:
    explicit StagingRing(uint64_t bytes) : bytes_(bytes) {}

    /// The start of a range that does not wrap around; nothing where what is out leaves no room.
    std::optional<uint64_t> allocate(uint64_t bytes) {
        uint64_t size = (bytes + kGrain - 1) / kGrain * kGrain;
        uint64_t start = head_;
        if (start % bytes_ + size > bytes_) start += bytes_ - start % bytes_;
        if (size > bytes_ || start + size - tail_ > bytes_) return std::nullopt;
        head_ = start + size;
        return start % bytes_;
    }
    /// What is handed out so far ends here ...
    uint64_t head() const { return head_; }
    /// ... and is all free again.
    void release(uint64_t head) { tail_ = std::max(tail_, head); }

private:
    static constexpr uint64_t kGrain = 16;
    uint64_t bytes_;
    uint64_t head_ = 0, tail_ = 0;  // never wrap; position in the ring is the remainder
};

}  // namespace aglow::vk
