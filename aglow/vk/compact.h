// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/kernel.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>

namespace aglow::vk {

/// Indices of the items whose flag is not 0, in order.
/// Synchronisation  Reads flags[count] (uint), writes indices[how many are set] and their number at
///                  `kept`. Starts and ends without barrier; two record() of one object need a
///                  barrier between them, as they share its scratch memory.
/// Shapes  fewer than 2^31 flags.
/// Cost    reads the flags twice.
class Compact {
public:
    static Result<Compact> create(const Gpu& gpu);
    Status reserve(uint64_t count);  ///< as Reduce::reserve()
    void record(Stream& stream, uint64_t flags, uint64_t count, uint64_t indices,
                uint64_t kept) const;

private:
    Compact(Gpu gpu, Kernel count, Kernel write, Scan scan)
        : gpu_(std::move(gpu)),
          count_(std::move(count)),
          write_(std::move(write)),
          scan_(std::move(scan)) {}

    Gpu gpu_;
    Kernel count_, write_;
    Scan scan_;
    Buffer kept_;  // of each block, then before each block
};

}  // namespace aglow::vk
