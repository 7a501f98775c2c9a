// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/compact.h"

#include "aglow/core/assert.h"
#include "aglow/shared/scan.h"
#include "aglow/vk/compact.comp.h"
#include "aglow/vk/compact_count.comp.h"
#include "aglow/vk/device.h"

namespace aglow::vk {

Result<Compact> Compact::create(const Gpu& gpu) {
    AG_TRY(auto count, Kernel::create(gpu, "compact: count", shaders::compact_count_comp));
    AG_TRY(auto write, Kernel::create(gpu, "compact", shaders::compact_comp));
    AG_TRY(auto scan, Scan::create(gpu));
    return Compact(gpu, std::move(count), std::move(write), std::move(scan));
}

Status Compact::reserve(uint64_t count) {
    const uint64_t blocks = group_count(count, shared::kScanBlock);
    AG_CHECK(scan_.reserve(blocks));
    return gpu_->grow(kept_, 4 * blocks, "items kept of each block");
}

void Compact::record(Stream& stream, uint64_t flags, uint64_t count, uint64_t indices,
                     uint64_t kept) const {
    AG_ASSERT(count >> 31 == 0, "fewer than 2^31 flags");
    const uint64_t blocks = group_count(count, shared::kScanBlock);
    AG_ASSERT(4 * blocks <= kept_.size(), "reserve() has seen the count");
    const shared::CompactArgs args{.first_group = 0,
                                   .count = static_cast<uint32_t>(count),
                                   .flags = flags,
                                   .kept = kept_.address(),
                                   .indices = indices};
    stream.run(count_, args, blocks);
    stream.barrier();
    scan_.record(stream, kept_.address(), kept_.address(), blocks, kept);
    stream.barrier();
    stream.run(write_, args, blocks);
}

}  // namespace aglow::vk
