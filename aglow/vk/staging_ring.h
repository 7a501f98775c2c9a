// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

namespace aglow::vk {

/// Hands out ranges of a ring of `bytes` bytes in order. Each is used by a numbered batch of work,
/// and free again when that has finished.
class StagingRing {
public:
    explicit StagingRing(uint64_t bytes) : bytes_(bytes) {}

    /// The start of a range that does not wrap around; nothing where what is in use leaves no room.
    std::optional<uint64_t> allocate(uint64_t bytes) {
        uint64_t size = (bytes + kGrain - 1) / kGrain * kGrain;
        uint64_t start = head_;
        if (start % bytes_ + size > bytes_) start += bytes_ - start % bytes_;
        if (start + size - tail_ > bytes_) return std::nullopt;
        head_ = start + size;
        return start % bytes_;
    }
    /// All that is handed out so far is free once `batch` has finished.
    void used_by(uint64_t batch) {
        if (uses_.empty() || uses_.back().batch != batch) uses_.push_back({batch, head_});
        uses_.back().head = head_;
    }
    void release_until(uint64_t batch) {
        for (; !uses_.empty() && uses_.front().batch <= batch; uses_.pop_front())
            tail_ = uses_.front().head;
    }
    /// The batch to wait for when there is no room.
    std::optional<uint64_t> oldest_batch() const {
        return uses_.empty() ? std::nullopt : std::optional(uses_.front().batch);
    }

private:
    static constexpr uint64_t kGrain = 16;
    struct Use {
        uint64_t batch, head;
    };
    uint64_t bytes_;
    uint64_t head_ = 0, tail_ = 0;  // never wrap; the place in the ring is the remainder
    std::deque<Use> uses_;
};

}  // namespace aglow::vk
