// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/buffer.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>

namespace aglow::shared {
struct ScanArgs;
}

namespace aglow::vk {

/// Exclusive prefix sums of uint, modulo 2^32: out[i] = in[0] + ... + in[i - 1]. Reduces blocks,
/// scans the sums, then scans the blocks, so no group ever waits for another.
/// Synchronisation  Reads `in`, writes `out` (which may be `in`) and, unless it is 0, the sum of
///                  all at `total`. Starts and ends without barrier; two record() of one object
///                  need a barrier between them, as they share its scratch memory.
/// Shapes  fewer than 2^32 values.
/// Cost    reads the values twice and writes them once.
/// Source  Sengupta, Harris, Zhang & Owens, "Scan Primitives for GPU Computing", Graphics Hardware
///         2007; Merrill & Grimshaw, "Parallel Scan for Stream Architectures", 2009.
class Scan {
public:
    static Result<Scan> create(const Gpu& gpu);
    Status reserve(uint64_t count);  ///< as Reduce::reserve()
    void record(Stream& stream, uint64_t in, uint64_t out, uint64_t count,
                uint64_t total = 0) const;

private:
    Scan(Gpu gpu, Kernel sum, Kernel scan)
        : gpu_(std::move(gpu)), sum_(std::move(sum)), scan_(std::move(scan)) {}
    void record_level(Stream& stream, const shared::ScanArgs& args, uint64_t unasked) const;

    Gpu gpu_;
    Kernel sum_, scan_;
    Buffer sums_;  // of the blocks, then of blocks of those, ...; last, a total nobody asked for
};

}  // namespace aglow::vk
