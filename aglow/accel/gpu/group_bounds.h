// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/core/math.h"
#include "aglow/shared/structure.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <span>
#include <vector>

namespace aglow::accel::gpu {

/// Bounding boxes of runs of triangles, on the host.
class GroupBounds {
public:
    static Result<GroupBounds> create(const Gpu& gpu);

    /// runs[i]: first triangle and count. A run without finite triangles has an empty box.
    /// Finishes the stream.
    /// Errors  out_of_memory, device_lost.
    /// Cost    reads the triangles once; 24 bytes come back per 4096 triangles.
    Result<std::vector<Box>> measure(vk::Stream& stream, TriangleSpan triangles,
                                     std::span<const uvec2> runs);

private:
    GroupBounds(Gpu gpu, vk::Kernel kernel) : gpu_(std::move(gpu)), kernel_(std::move(kernel)) {}
    Status reserve(uint64_t pieces);

    Gpu gpu_;
    vk::Kernel kernel_;
    vk::Buffer pieces_;  // uvec2, at most kPieceLength triangles each
    vk::Buffer boxes_;   // one for each piece
};

}  // namespace aglow::accel::gpu
