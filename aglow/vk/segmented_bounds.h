// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

namespace aglow::vk {

/// Bounding box of each segment of an array of boxes (shared::Bounds). Segment s holds boxes
/// starts[s] to starts[s + 1]; an empty one gives lower = +inf, upper = -inf.
/// Synchronisation  Reads boxes and starts[segments + 1] (uint), writes out[segments]. Starts and
///                  ends without barrier.
/// Cost    reads the boxes once, whatever the lengths of the segments.
class SegmentedBounds {
public:
    static Result<SegmentedBounds> create(const Gpu& gpu);
    Status reserve(uint64_t count, uint64_t segments);  ///< as Reduce::reserve()
    void record(Stream& stream, uint64_t boxes, uint64_t count, uint64_t starts, uint64_t segments,
                uint64_t out) const;

private:
    // ... to be filled in
};

}  // namespace aglow::vk
