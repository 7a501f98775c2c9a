// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/buffer.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <vector>

namespace aglow::vk {

enum class Reduction : uint8_t { sum_uint, max_uint, min_float, max_float };

/// One value from many: their sum (modulo 2^32) or extreme. 0 for no uint and -inf, +inf for the
/// maximum and minimum of no floats.
/// Synchronisation  Reads `values`, writes 4 bytes at `result`. Starts and ends without barrier.
/// Repeat  same bits every run and on every device.
/// Cost    reads the values once.
class Reduce {
public:
    static Result<Reduce> create(const Gpu& gpu, Reduction reduction);
    /// Scratch memory for up to `count` values. Call before record(), between finished streams.
    /// Errors  out_of_memory.
    Status reserve(uint64_t count);
    void record(Stream& stream, uint64_t values, uint64_t count, uint64_t result) const;

private:
    // ... to be filled in
};

}  // namespace aglow::vk
