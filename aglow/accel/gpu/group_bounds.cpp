// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/group_bounds.h"

#include "aglow/accel/gpu/group_bounds.comp.h"
#include "aglow/vk/device.h"

#include <algorithm>

namespace aglow::accel::gpu {
namespace {

constexpr uint32_t kPieceLength = 4096;  // triangles per workgroup

}  // namespace

Result<GroupBounds> GroupBounds::create(const Gpu& gpu) {
    AG_TRY(vk::Kernel kernel, vk::Kernel::create(gpu, "group bounds", shaders::group_bounds_comp));
    return GroupBounds(gpu, std::move(kernel));
}

Status GroupBounds::reserve(uint64_t pieces) {
    AG_CHECK(gpu_->grow(pieces_, pieces * sizeof(uvec2), "group bounds: pieces"));
    return gpu_->grow(boxes_, pieces * sizeof(shared::Bounds), "group bounds: boxes");
}

Result<std::vector<Box>> GroupBounds::measure(vk::Stream& stream, TriangleSpan triangles,
                                              std::span<const uvec2> runs) {
    std::vector<uvec2> pieces;
    for (const uvec2 run : runs)
        for (uint32_t left = run.y; left > 0; left -= std::min(kPieceLength, left))
            pieces.push_back({run.x + run.y - left, std::min(kPieceLength, left)});
    std::vector<Box> boxes(runs.size());
    if (pieces.empty()) return boxes;

    AG_CHECK(reserve(pieces.size()));
    stream.upload(std::span<const uvec2>(pieces), pieces_);
    stream.barrier();
    stream.run(kernel_,
               shared::GroupBoundsArgs{.first_group = 0,
                                       .padding = 0,
                                       .triangles = triangles.address,
                                       .runs = pieces_.address(),
                                       .boxes = boxes_.address()},
               pieces.size());
    AG_TRY(const auto parts, stream.download<shared::Bounds>(boxes_, pieces.size()));
    size_t piece = 0;
    for (size_t i = 0; i < runs.size(); ++i)
        for (uint32_t left = runs[i].y; left > 0; left -= std::min(kPieceLength, left), ++piece) {
            boxes[i].lo = shared::min(boxes[i].lo, parts[piece].lower);
            boxes[i].hi = shared::max(boxes[i].hi, parts[piece].upper);
        }
    return boxes;
}

}  // namespace aglow::accel::gpu
