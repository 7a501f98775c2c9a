// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/free_list.h"

#include "aglow/core/assert.h"

#include <iterator>

namespace aglow::vk {

FreeList::FreeList(uint64_t bytes) : bytes_(bytes) { add(0, bytes); }

void FreeList::add(uint64_t offset, uint64_t bytes) {
    if (bytes == 0) return;
    by_offset_.emplace(offset, bytes);
    by_size_.emplace(bytes, offset);
    free_bytes_ += bytes;
}

void FreeList::remove(std::map<uint64_t, uint64_t>::iterator range) {
    free_bytes_ -= range->second;
    by_size_.erase({range->second, range->first});
    by_offset_.erase(range);
}

std::optional<uint64_t> FreeList::allocate(uint64_t bytes, uint64_t alignment) {
    for (auto fit = by_size_.lower_bound({bytes, 0}); fit != by_size_.end(); ++fit) {
        auto [size, offset] = *fit;
        uint64_t start = (offset + alignment - 1) & ~(alignment - 1);
        uint64_t skipped = start - offset;
        if (skipped + bytes > size) continue;  // too short once its start is aligned
        remove(by_offset_.find(offset));
        add(offset, skipped);
        add(start + bytes, size - skipped - bytes);
        return start;
    }
    return std::nullopt;
}

void FreeList::free(uint64_t offset, uint64_t bytes) {
    auto next = by_offset_.lower_bound(offset);
    if (next != by_offset_.end()) AG_ASSERT(offset + bytes <= next->first, "freed once");
    if (next != by_offset_.begin()) {
        auto before = std::prev(next);
        AG_ASSERT(before->first + before->second <= offset, "freed once");
        if (before->first + before->second == offset) {
            offset = before->first;
            bytes += before->second;
            remove(before);
        }
    }
    if (next != by_offset_.end() && next->first == offset + bytes) {
        bytes += next->second;
        remove(next);
    }
    add(offset, bytes);
}

}  // namespace aglow::vk
