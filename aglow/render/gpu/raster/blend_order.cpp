// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/blend_order.h"

#include "aglow/render/gpu/raster/order.comp.h"

#include <span>

namespace aglow::render::gpu {
namespace {

/// Push constants of order.comp.
struct OrderArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t scene = 0, frame = 0;
    uint64_t faces = 0, keys = 0, sortable = 0;
};

}  // namespace

Result<BlendOrder> BlendOrder::create(vk::Stream& stream, const std::vector<uint32_t>& faces) {
    const Gpu& gpu = stream.gpu();
    AG_TRY(vk::Kernel order, vk::Kernel::create(gpu, "order", shaders::order_comp));
    AG_TRY(vk::RadixSort sort, vk::RadixSort::create(gpu));
    AG_CHECK(sort.reserve(faces.size()));
    BlendOrder made(std::move(order), std::move(sort));
    AG_TRY(made.faces_,
           vk::make_buffer_of(stream, std::span<const uint32_t>(faces), "blended triangles"));
    AG_TRY(made.keys_, stream.make_buffer(4 * faces.size(), "depths of blended triangles"));
    AG_TRY(made.sortable_, stream.make_buffer(4 * faces.size(), "order of blended triangles"));
    made.count_ = static_cast<uint32_t>(faces.size());
    return made;
}

uint64_t BlendOrder::record(vk::Stream& stream, uint64_t scene, uint64_t frame) const {
    stream.run(
        order_,
        OrderArgs{0, count_, scene, frame, faces_.address(), keys_.address(), sortable_.address()},
        vk::group_count(count_, 64));
    stream.barrier();
    const uint64_t sorted =
        sort_.record(stream, keys_.address(), sortable_.address(), count_, 32).values;
    stream.barrier();
    return sorted;
}

}  // namespace aglow::render::gpu
