// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/radix_sort.h"

#include "aglow/core/assert.h"
#include "aglow/shared/radix_sort.h"
#include "aglow/vk/device.h"
#include "aglow/vk/radix_count.comp.h"
#include "aglow/vk/radix_scatter.comp.h"

#include <array>

namespace aglow::vk {
namespace {

uint64_t tile_count(uint64_t count) { return group_count(count, shared::kRadixTile); }

/// Memory for the counts of each digit in each tile and in each run.
uint64_t counts_bytes(uint64_t tiles) {
    return 4 * tiles * shared::kRadixDigits * (1 + shared::kRadixRuns);
}

}  // namespace

Result<RadixSort> RadixSort::create(const Gpu& gpu) {
    const std::array invocations = {shared::kRadixRuns * gpu->subgroup_size()};
    AG_TRY(auto count, Kernel::create(gpu, "sort: count", shaders::radix_count_comp, invocations));
    AG_TRY(auto scatter,
           Kernel::create(gpu, "sort: scatter", shaders::radix_scatter_comp, invocations));
    AG_TRY(auto scan, Scan::create(gpu));
    return RadixSort(gpu, std::move(count), std::move(scatter), std::move(scan));
}

Status RadixSort::reserve(uint64_t count) {
    const uint64_t tiles = tile_count(count);
    AG_CHECK(scan_.reserve(tiles * shared::kRadixDigits));
    AG_CHECK(gpu_->grow(keys_, 4 * count, "keys being sorted"));
    AG_CHECK(gpu_->grow(values_, 4 * count, "values being sorted"));
    return gpu_->grow(counts_, counts_bytes(tiles), "digit counts of a sort");
}

Sorted RadixSort::record(Stream& stream, uint64_t keys, uint64_t values, uint64_t count,
                         uint32_t key_bits) const {
    AG_ASSERT(count >> 31 == 0, "fewer than 2^31 pairs");
    AG_ASSERT(4 * count <= keys_.size(), "reserve() has seen the count");
    AG_ASSERT(key_bits <= 32, "keys of at most 32 bits");
    Sorted from{keys, values};
    Sorted to{keys_.address(), values_.address()};
    if (count < 2 || key_bits == 0) return from;

    // As few digits as possible, all of the same width.
    const uint32_t passes = (key_bits + shared::kRadixDigitBits - 1) / shared::kRadixDigitBits;
    const uint32_t digit_bits = (key_bits + passes - 1) / passes;
    const uint64_t tiles = tile_count(count);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        const shared::RadixArgs args{.first_group = 0,
                                     .count = static_cast<uint32_t>(count),
                                     .tile_count = static_cast<uint32_t>(tiles),
                                     .shift = pass * digit_bits,
                                     .digit_bits = digit_bits,
                                     .keys = from.keys,
                                     .values = from.values,
                                     .tile_counts = counts_.address(),
                                     .run_counts = counts_.address() + 4 * (tiles << digit_bits),
                                     .sorted_keys = to.keys,
                                     .sorted_values = to.values};
        if (pass > 0) stream.barrier();
        stream.run(count_, args, tiles);
        stream.barrier();
        scan_.record(stream, counts_.address(), counts_.address(), tiles << digit_bits);
        stream.barrier();
        stream.run(scatter_, args, tiles);
        std::swap(from, to);
    }
    return from;
}

}  // namespace aglow::vk
