// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace aglow::vk {

/// Hands out ranges of [0, bytes): best fit, and what comes back joins its free neighbours at once.
/// Cost    O(log(free ranges)) each way.
/// Source  Knuth, The Art of Computer Programming, vol. 1, section 2.5.
class FreeList {
public:
    explicit FreeList(uint64_t bytes);

    /// The start of a free range, a multiple of `alignment` (a power of two).
    std::optional<uint64_t> allocate(uint64_t bytes, uint64_t alignment);
    void free(uint64_t offset, uint64_t bytes);

    uint64_t free_bytes() const { return free_bytes_; }
    bool unused() const { return free_bytes_ == bytes_; }

private:
    using BySize = std::set<std::pair<uint64_t, uint64_t>>;  // bytes, offset
    void add(uint64_t offset, uint64_t bytes);
    void remove(std::map<uint64_t, uint64_t>::iterator range);

    uint64_t bytes_ = 0;
    uint64_t free_bytes_ = 0;
    std::map<uint64_t, uint64_t> by_offset_;  // bytes of the free range that starts there
    BySize by_size_;
};

}  // namespace aglow::vk
