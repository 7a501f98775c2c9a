// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/buffer.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/stream.h"

namespace aglow::vk {

/// Addresses of sorted uint keys and their values.
struct Sorted {
    uint64_t keys = 0, values = 0;
};

/// Stable sort of 32-bit keys with 32-bit values by the low `key_bits` bits of the keys, which must
/// hold all bits that are set; only as many digits are sorted as that takes.
/// Synchronisation  Overwrites `keys` and `values`. Starts and ends without barrier.
/// Result  where the sorted pairs lie: in `keys` and `values`, or in the sorter's own memory, where
///         the next record() overwrites them.
/// Source  Merrill & Grimshaw, "High Performance and Scalable Radix Sorting", 2011.
class RadixSort {
public:
    static Result<RadixSort> create(const Gpu& gpu);
    Status reserve(uint64_t count);  ///< as Reduce::reserve()
    [[nodiscard]] Sorted record(Stream& stream, uint64_t keys, uint64_t values, uint64_t count,
                                uint32_t key_bits) const;

private:
    // ... to be filled in
};

}  // namespace aglow::vk
