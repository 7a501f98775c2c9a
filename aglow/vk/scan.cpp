// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/scan.h"

#include "aglow/core/assert.h"
#include "aglow/shared/scan.h"
#include "aglow/vk/device.h"
#include "aglow/vk/reduce.comp.h"
#include "aglow/vk/reduce.h"
#include "aglow/vk/scan.comp.h"

#include <algorithm>

namespace aglow::vk {

Result<Scan> Scan::create(const Gpu& gpu) {
    AG_TRY(auto sum, Kernel::create(gpu, "scan: sums", shaders::reduce_comp));
    AG_TRY(auto scan, Kernel::create(gpu, "scan", shaders::scan_comp));
    return Scan(gpu, std::move(sum), std::move(scan));
}

Status Scan::reserve(uint64_t count) {
    return gpu_->grow(sums_, 4 * (block_result_count(count) + 1), "sums of a scan's blocks");
}

void Scan::record(Stream& stream, uint64_t in, uint64_t out, uint64_t count, uint64_t total) const {
    AG_ASSERT(count >> 32 == 0, "fewer than 2^32 values");
    AG_ASSERT(4 * (block_result_count(count) + 1) <= sums_.size(), "reserve() has seen the count");
    const uint64_t unasked = sums_.address() + 4 * block_result_count(count);
    record_level(stream,
                 {.first_group = 0,
                  .count = static_cast<uint32_t>(count),
                  .values = in,
                  .sums = out,
                  .carries = sums_.address(),
                  .total = total != 0 ? total : unasked},
                 unasked);
}

// Sums the blocks, scans the sums in their place by the same way, then scans the blocks.
void Scan::record_level(Stream& stream, const shared::ScanArgs& args, uint64_t unasked) const {
    const uint64_t blocks = std::max<uint64_t>(group_count(args.count, shared::kScanBlock), 1);
    if (blocks > 1) {
        stream.run(sum_,
                   shared::ReduceArgs{.first_group = 0,
                                      .count = args.count,
                                      .values = args.values,
                                      .results = args.carries},
                   blocks);
        stream.barrier();
        record_level(stream,
                     {.first_group = 0,
                      .count = static_cast<uint32_t>(blocks),
                      .values = args.carries,
                      .sums = args.carries,
                      .carries = args.carries + 4 * blocks,
                      .total = unasked},
                     unasked);
        stream.barrier();
    }
    stream.run(scan_, args, blocks);
}

}  // namespace aglow::vk
