// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>

namespace aglow::vk {

/// Bounding box of each segment of an array of boxes (shared::Bounds). Segment s holds boxes
/// starts[s] to starts[s + 1]; an empty one gives lower = +inf, upper = -inf.
/// Synchronisation  Reads boxes and starts[segments + 1] (uint), writes out[segments]. Starts and
///                  ends without barrier.
/// Shapes  fewer than 2^31 boxes and 2^31 segments; starts[0] = 0, starts[segments] = count.
/// Repeat  same bits every run; -0 counts as less than +0, corners must not be NaN.
/// Cost    reads the boxes once, in parts of like size whatever the lengths of the segments, and
///         goes over `out` three times. Needs no scratch memory.
/// Source  Sengupta, Harris, Zhang & Owens, "Scan Primitives for GPU Computing", Graphics Hardware
///         2007 (segmented scan).
class SegmentedBounds {
public:
    static Result<SegmentedBounds> create(const Gpu& gpu);
    void record(Stream& stream, uint64_t boxes, uint64_t count, uint64_t starts, uint64_t segments,
                uint64_t out) const;

private:
    SegmentedBounds(Kernel clear, Kernel combine, Kernel decode)
        : clear_(std::move(clear)), combine_(std::move(combine)), decode_(std::move(decode)) {}

    Kernel clear_, combine_, decode_;
};

}  // namespace aglow::vk
