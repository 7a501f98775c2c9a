// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/grid/grid_level.h"

#include "aglow/accel/gpu/grid/grid_bounds.comp.h"
#include "aglow/accel/gpu/grid/grid_pairs.comp.h"
#include "aglow/accel/gpu/grid/grid_shape.comp.h"
#include "aglow/accel/gpu/grid/grid_skip.comp.h"
#include "aglow/accel/gpu/grid/grid_split.comp.h"
#include "aglow/accel/gpu/grid/grid_spread.comp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>

namespace aglow::accel::gpu {

using shared::kGridGroupSize;

namespace {

// References are numbered by 31 bits.
constexpr uint64_t kMostPairs = 0x7fffffff;

uint64_t sum(uvec2 words) { return words.x + uint64_t{words.y} * 4096; }

uint64_t plane_words(uvec3 r) { return uint64_t{shared::row_words(r.x)} * r.y * r.z; }

}  // namespace

// Meshes of even triangles have 2 to 4 pairs each at the densities used. Beyond 24 the build costs
// more than rays gain; a million cost little whatever the scene.
uint64_t pair_limit(uint64_t triangles) {
    return std::min(kMostPairs, std::max<uint64_t>(24 * triangles, 1u << 20));
}

Result<GridLevel> GridLevel::create(const Gpu& gpu, uint32_t level) {
    const std::array<uint32_t, 2> counting = {0, level};
    const std::array<uint32_t, 2> writing = {1, level};
    AG_TRY(auto split, vk::Kernel::create(gpu, "grid split", shaders::grid_split_comp, counting));
    AG_TRY(auto count, vk::Kernel::create(gpu, "grid count", shaders::grid_pairs_comp, counting));
    AG_TRY(auto write, vk::Kernel::create(gpu, "grid pairs", shaders::grid_pairs_comp, writing));
    AG_TRY(auto scan, vk::Scan::create(gpu));
    AG_TRY(auto sorter, vk::RadixSort::create(gpu));
    return GridLevel(gpu, std::move(split), std::move(count), std::move(write), std::move(scan),
                     std::move(sorter));
}

Result<GridLevel::Count> GridLevel::count(vk::Stream& stream, const vk::Buffer& work,
                                          shared::GridPairsArgs jobs) {
    // Of 64 columns of a large triangle's box at least 16 hold a pair, or it is a rare sliver.
    const uint64_t most_extras = pair_limit(jobs.job_count) / 16;
    for (;;) {
        AG_CHECK(reserve_items(stream, jobs.job_count, extra_count_));
        jobs.item_count = jobs.job_count + static_cast<uint32_t>(extra_count_);
        jobs.extras = extras_.address();
        jobs.counts = counts_.address();
        stream.barrier();
        stream.fill(work, 0, offsetof(shared::GridWork, extras), 2 * sizeof(uvec2));
        stream.barrier();
        stream.run(split_, jobs, vk::group_count(jobs.job_count, kGridGroupSize));
        stream.barrier();
        if (extra_count_ > 0) {
            scan_.record(stream, jobs.extras, jobs.extras, jobs.job_count);
            stream.barrier();
        }
        stream.run(count_, jobs, vk::group_count(jobs.item_count, kGridGroupSize));
        stream.barrier();
        scan_.record(stream, jobs.counts, jobs.counts, jobs.item_count);
        Count result;
        AG_CHECK(
            stream.download_bytes(work, 0, std::as_writable_bytes(std::span(&result.work, 1))));
        jobs_ = jobs;
        const uint64_t extras = sum(result.work.extras);
        if (extras > most_extras) {
            result.pairs = std::numeric_limits<uint64_t>::max();
            return result;
        }
        if (extras <= extra_count_) {
            result.pairs = sum(result.work.pairs);
            return result;
        }
        extra_count_ = extras + extras / 8;
    }
}

Status GridLevel::reserve_items(vk::Stream& stream, uint64_t jobs, uint64_t extras) {
    if (jobs + extras <= item_capacity_) return {};
    AG_CHECK(stream.finish());  // another structure's build may still use the memory
    item_capacity_ = 0;
    AG_CHECK(gpu_->grow(extras_, jobs * 4, "grid work items"));
    AG_CHECK(gpu_->grow(counts_, (jobs + extras) * 4, "grid pair counts"));
    const uint64_t capacity = std::min(extras_.size(), counts_.size()) / 4;
    AG_CHECK(scan_.reserve(counts_.size() / 4));
    item_capacity_ = std::max(capacity, jobs + extras);
    return {};
}

Status GridLevel::reserve_pairs(uint64_t pairs) {
    AG_CHECK(gpu_->grow(keys_, pairs * 4, "grid pairs' cells"));
    AG_CHECK(gpu_->grow(values_, pairs * 4, "grid pairs' triangles"));
    return sorter_.reserve(pairs);
}

Result<vk::Sorted> GridLevel::sort(vk::Stream& stream, uint64_t pairs, uint64_t cells) {
    AG_CHECK(reserve_pairs(pairs));
    jobs_.keys = keys_.address();
    jobs_.values = values_.address();
    stream.run(write_, jobs_, vk::group_count(jobs_.item_count, kGridGroupSize));
    stream.barrier();
    const auto bits = static_cast<uint32_t>(std::bit_width(cells - 1));
    const vk::Sorted sorted =
        sorter_.record(stream, jobs_.keys, jobs_.values, pairs, std::max(bits, 1u));
    stream.barrier();
    return sorted;
}

Result<GridSkips> GridSkips::create(const Gpu& gpu) {
    AG_TRY(auto spread, vk::Kernel::create(gpu, "grid spread", shaders::grid_spread_comp));
    AG_TRY(auto skip, vk::Kernel::create(gpu, "grid skip", shaders::grid_skip_comp));
    return GridSkips(gpu, std::move(spread), std::move(skip));
}

Status GridSkips::start(vk::Stream& stream, uvec3 resolution) {
    const uint64_t plane_bytes = plane_words(resolution) * 4;
    AG_CHECK(gpu_->grow(planes_, (shared::kSkipLevels + 1) * plane_bytes, "grid occupancy"));
    stream.fill(planes_, 0, 0, plane_bytes);
    return {};
}

void GridSkips::record(vk::Stream& stream, uint64_t cells, uvec3 resolution) const {
    const uint64_t words = plane_words(resolution);
    const uint32_t longest = std::max({resolution.x, resolution.y, resolution.z});
    uint32_t levels = 0;
    for (; levels < shared::kSkipLevels && (1u << levels) < longest; ++levels) {
        const shared::GridSpreadArgs spread = {.first_group = 0,
                                               .step = std::max(1u, (1u << levels) / 2),
                                               .from = occupied() + levels * words * 4,
                                               .to = occupied() + (levels + 1) * words * 4,
                                               .resolution = resolution};
        stream.run(spread_, spread, vk::group_count(words, kGridGroupSize));
        stream.barrier();
    }
    const shared::GridSkipArgs skip = {.first_group = 0,
                                       .levels = levels,
                                       .cells = cells,
                                       .occupied = occupied(),
                                       .resolution = resolution};
    stream.run(skip_, skip, vk::group_count(cell_count(resolution), kGridGroupSize));
}

Result<GridBounds> GridBounds::create(const Gpu& gpu) {
    AG_TRY(auto bounds, vk::Kernel::create(gpu, "grid bounds", shaders::grid_bounds_comp));
    AG_TRY(auto shape, vk::Kernel::create(gpu, "grid shape", shaders::grid_shape_comp));
    AG_TRY(auto work, gpu->make_buffer(sizeof(shared::GridWork), "grid work"));
    return GridBounds(std::move(bounds), std::move(shape), std::move(work));
}

void GridBounds::record(vk::Stream& stream, uint64_t from, uint64_t to, uint32_t count) const {
    constexpr uint32_t kLast = 0xffffffff;
    const shared::GridWork nothing = {.lower = {kLast, kLast, kLast},
                                      .upper = {},
                                      .shape = {},
                                      .extras = {},
                                      .pairs = {},
                                      .leaf_cells = 0};
    stream.upload(std::span(&nothing, 1), work_);
    stream.barrier();
    const shared::GridBoundsArgs args = {
        .first_group = 0, .count = count, .from = from, .to = to, .work = work_.address()};
    stream.run(bounds_, args,
               vk::group_count(count, kGridGroupSize * shared::kBoundsPerInvocation));
}

void GridBounds::shape(vk::Stream& stream, float cells) const {
    stream.run(shape_,
               shared::GridShapeArgs{.first_group = 0, .cells = cells, .work = work_.address()}, 1);
}

Result<GridLevel::Count> choose_shape(vk::Stream& stream, const GridBounds& bounds,
                                      GridLevel& level, TriangleSpan triangles,
                                      float cells_per_triangle) {
    shared::GridPairsArgs jobs = {};
    jobs.job_count = triangles.count;
    jobs.triangles = triangles.address;
    jobs.work = bounds.work().address();
    // 31 bits number cells too.
    float cells = std::min(cells_per_triangle * static_cast<float>(triangles.count), 0x1p30f);
    for (;; cells /= 4) {
        stream.barrier();
        bounds.shape(stream, cells);
        AG_TRY(const GridLevel::Count count, level.count(stream, bounds.work(), jobs));
        if (count.pairs <= pair_limit(triangles.count)) return count;
    }
}

Error about_grid(Error error, std::string_view what, uint64_t triangles) {
    if (error.code == Errc::out_of_memory) {
        error.message = fmt::format("a {} over {} triangles: {}", what, triangles, error.message);
    }
    return error;
}

}  // namespace aglow::accel::gpu
