// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/reduce.h"

#include "aglow/core/assert.h"
#include "aglow/shared/scan.h"
#include "aglow/vk/device.h"
#include "aglow/vk/reduce.comp.h"

#include <array>

namespace aglow::vk {

static_assert(shared::kReduceSum == static_cast<uint32_t>(Reduction::sum_uint));
static_assert(shared::kReduceMax == static_cast<uint32_t>(Reduction::max_uint));
static_assert(shared::kReduceMinFloat == static_cast<uint32_t>(Reduction::min_float));
static_assert(shared::kReduceMaxFloat == static_cast<uint32_t>(Reduction::max_float));

uint64_t block_result_count(uint64_t count) {
    uint64_t results = 0;
    do {
        count = group_count(count, shared::kScanBlock);
        results += count;
    } while (count > 1);
    return results;
}

Result<Reduce> Reduce::create(const Gpu& gpu, Reduction reduction) {
    const std::array constants = {static_cast<uint32_t>(reduction)};
    AG_TRY(auto kernel, Kernel::create(gpu, "reduce", shaders::reduce_comp, constants));
    return Reduce(gpu, std::move(kernel));
}

Status Reduce::reserve(uint64_t count) {
    return gpu_->grow(partial_, 4 * block_result_count(count), "results of a reduction's blocks");
}

void Reduce::record(Stream& stream, uint64_t values, uint64_t count, uint64_t result) const {
    AG_ASSERT(count >> 32 == 0, "fewer than 2^32 values");
    AG_ASSERT(4 * block_result_count(count) <= partial_.size(), "reserve() has seen the count");
    uint64_t partial = partial_.address();
    for (;;) {
        const uint64_t blocks = group_count(count, shared::kScanBlock);
        const bool last = blocks <= 1;  // of no values too: writes what those combine to
        stream.run(kernel_,
                   shared::ReduceArgs{.first_group = 0,
                                      .count = static_cast<uint32_t>(count),
                                      .values = values,
                                      .results = last ? result : partial},
                   last ? 1 : blocks);
        if (last) return;
        stream.barrier();
        values = partial;
        count = blocks;
        partial += 4 * blocks;
    }
}

}  // namespace aglow::vk
