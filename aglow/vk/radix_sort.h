// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/buffer.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>

namespace aglow::vk {

/// Addresses of sorted uint keys and their values.
struct Sorted {
    uint64_t keys = 0, values = 0;
};

/// Stable sort of 32-bit keys with 32-bit values by the low `key_bits` bits of the keys, which must
/// hold all bits that are set; only as many digits are sorted as that takes.
/// Shapes  fewer than 2^31 pairs; key_bits <= 32.
/// Synchronisation  Overwrites `keys` and `values`. Starts and ends without barrier.
/// Result  where the sorted pairs lie: in `keys` and `values`, or in the sorter's own memory, where
///         the next record() overwrites them.
/// Cost    per 8 bits of the keys: keys are read twice, values once, both are written once.
///         Scratch memory is 10.3 bytes a pair.
/// Source  Merrill & Grimshaw, "High Performance and Scalable Radix Sorting", Parallel Processing
///         Letters 21(2), 2011; places among equal digits after Ashkiani, Davidson, Meyer & Owens,
///         "GPU Multisplit", PPoPP 2016.
class RadixSort {
public:
    static Result<RadixSort> create(const Gpu& gpu);
    Status reserve(uint64_t count);  ///< as Reduce::reserve()
    [[nodiscard]] Sorted record(Stream& stream, uint64_t keys, uint64_t values, uint64_t count,
                                uint32_t key_bits) const;

private:
    RadixSort(Gpu gpu, Kernel count, Kernel scatter, Scan scan)
        : gpu_(std::move(gpu)),
          count_(std::move(count)),
          scatter_(std::move(scatter)),
          scan_(std::move(scan)) {}

    Gpu gpu_;
    Kernel count_, scatter_;
    Scan scan_;
    Buffer keys_, values_;  // every other pass writes here
    Buffer counts_;         // of each digit in each tile, then in each run
};

}  // namespace aglow::vk
