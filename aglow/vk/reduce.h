// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/buffer.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>

namespace aglow::vk {

enum class Reduction : uint8_t { sum_uint, max_uint, min_float, max_float };

/// Results of all blocks of `count` values, of all blocks of those, and so on down to one: the
/// scratch memory of a reduction or a prefix sum, in values.
uint64_t block_result_count(uint64_t count);

/// One value from many: their sum (modulo 2^32) or extreme. 0 for no uint and -inf, +inf for the
/// maximum and minimum of no floats; -0 counts as less than +0, floats must not be NaN.
/// Shapes  fewer than 2^32 values.
/// Synchronisation  Reads `values`, writes 4 bytes at `result`. Starts and ends without barrier;
/// two
///                  record() of one object need a barrier between them, as they share its scratch.
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
    explicit Reduce(Gpu gpu, Kernel kernel) : gpu_(std::move(gpu)), kernel_(std::move(kernel)) {}

    Gpu gpu_;
    Kernel kernel_;
    Buffer partial_;  // results of the blocks, then of blocks of those, ...
};

}  // namespace aglow::vk
