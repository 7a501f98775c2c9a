// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/segmented_bounds.h"

#include "aglow/core/assert.h"
#include "aglow/shared/segmented_bounds.h"
#include "aglow/vk/segmented_bounds.comp.h"
#include "aglow/vk/segmented_bounds_clear.comp.h"
#include "aglow/vk/segmented_bounds_decode.comp.h"

namespace aglow::vk {

Result<SegmentedBounds> SegmentedBounds::create(const Gpu& gpu) {
    AG_TRY(auto clear,
           Kernel::create(gpu, "segmented bounds: clear", shaders::segmented_bounds_clear_comp));
    AG_TRY(auto combine, Kernel::create(gpu, "segmented bounds", shaders::segmented_bounds_comp));
    AG_TRY(auto decode,
           Kernel::create(gpu, "segmented bounds: decode", shaders::segmented_bounds_decode_comp));
    return SegmentedBounds(std::move(clear), std::move(combine), std::move(decode));
}

void SegmentedBounds::record(Stream& stream, uint64_t boxes, uint64_t count, uint64_t starts,
                             uint64_t segments, uint64_t out) const {
    AG_ASSERT(count >> 31 == 0, "fewer than 2^31 boxes");
    AG_ASSERT(segments >> 31 == 0, "fewer than 2^31 segments");
    const shared::SegmentedBoundsArgs args{.first_group = 0,
                                           .count = static_cast<uint32_t>(count),
                                           .segment_count = static_cast<uint32_t>(segments),
                                           .boxes = boxes,
                                           .starts = starts,
                                           .minima = out,
                                           .bounds = out};
    const uint64_t segment_groups = group_count(segments, shared::kBoundsGroup);
    stream.run(clear_, args, segment_groups);
    stream.barrier();
    stream.run(combine_, args, group_count(count, shared::kBoundsGroup * shared::kBoundsRun));
    stream.barrier();
    stream.run(decode_, args, segment_groups);
}

}  // namespace aglow::vk
