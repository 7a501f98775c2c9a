// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/kernel.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/stream.h"

namespace aglow::vk {

/// Indices of the items whose flag is not 0, in order.
/// Synchronisation  Reads flags[count] (uint), writes indices[how many are set] and their number at
///                  `kept`. Starts and ends without barrier.
class Compact {
public:
    static Result<Compact> create(const Gpu& gpu);
    Status reserve(uint64_t count);  ///< as Reduce::reserve()
    void record(Stream& stream, uint64_t flags, uint64_t count, uint64_t indices,
                uint64_t kept) const;

private:
    // ... to be filled in
};

}  // namespace aglow::vk
