// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/radix_sort.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace aglow::render::gpu {

/// Blended faces and what sorts them.
class BlendOrder {
public:
    /// Errors  out_of_memory.
    static Result<BlendOrder> create(vk::Stream& stream, const std::vector<uint32_t>& faces);

    /// `scene` and `frame` are the addresses of shared::DeviceScene and shared::RasterFrame.
    /// Result           address of the faces from the farthest to the nearest.
    /// Synchronisation  starts without barrier, ends with one.
    uint64_t record(vk::Stream& stream, uint64_t scene, uint64_t frame) const;

    uint32_t count() const { return count_; }

private:
    BlendOrder(vk::Kernel order, vk::RadixSort sort)
        : order_(std::move(order)), sort_(std::move(sort)) {}

    vk::Kernel order_;
    vk::RadixSort sort_;
    vk::Buffer faces_, keys_, sortable_;
    uint32_t count_ = 0;
};

}  // namespace aglow::render::gpu
