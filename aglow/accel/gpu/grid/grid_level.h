// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/core/math.h"
#include "aglow/shared/grid2.h"
#include "aglow/vk/device.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/radix_sort.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <string_view>
#include <utility>

namespace aglow::accel::gpu {

/// More pairs than this many triangles should have: the grid is then too fine for them.
uint64_t pair_limit(uint64_t triangles);

/// One level of a grid in the making: kernels and scratch memory for pairs of a cell and a triangle
/// that overlaps it, in order of cells.
class GridLevel {
public:
    /// `level` is one of shared::kGrid...Level.
    static Result<GridLevel> create(const Gpu& gpu, uint32_t level);

    struct Count {
        shared::GridWork work;  ///< as it is after all that was recorded before
        uint64_t pairs = 0;     ///< UINT64_MAX: too many to count
    };
    /// Counts the pairs of `jobs`, whose members from `extras` to `values` are ignored, and
    /// finish()es the stream. `work` is the buffer at jobs.work. Starts without barrier.
    Result<Count> count(vk::Stream& stream, const vk::Buffer& work, shared::GridPairsArgs jobs);

    /// Writes and sorts the pairs of the jobs of the last count(). Ends with a barrier. The result
    /// lives until the next sort().
    Result<vk::Sorted> sort(vk::Stream& stream, uint64_t pairs, uint64_t cells);

private:
    GridLevel(Gpu gpu, vk::Kernel split, vk::Kernel count, vk::Kernel write, vk::Scan scan,
              vk::RadixSort sorter)
        : gpu_(std::move(gpu)),
          split_(std::move(split)),
          count_(std::move(count)),
          write_(std::move(write)),
          scan_(std::move(scan)),
          sorter_(std::move(sorter)) {}
    Status reserve_items(vk::Stream& stream, uint64_t jobs, uint64_t extras);
    Status reserve_pairs(uint64_t pairs);

    Gpu gpu_;
    vk::Kernel split_, count_, write_;
    vk::Scan scan_;
    vk::RadixSort sorter_;
    vk::Buffer extras_, counts_, keys_, values_;
    uint64_t item_capacity_ = 0;
    uint64_t extra_count_ = 0;  // room for these is made without asking
    shared::GridPairsArgs jobs_ = {};
};

/// Finds out how far it is from each empty cell to the next occupied one.
class GridSkips {
public:
    static Result<GridSkips> create(const Gpu& gpu);
    /// Memory for a grid, as vk::Reduce::reserve(); and clears the bits of its cells.
    Status start(vk::Stream& stream, uvec3 resolution);
    /// Where grid_cells marks occupied cells.
    uint64_t occupied() const { return planes_.address(); }
    /// Writes the distances into empty cells. Starts and ends without barrier.
    void record(vk::Stream& stream, uint64_t cells, uvec3 resolution) const;

private:
    GridSkips(Gpu gpu, vk::Kernel spread, vk::Kernel skip)
        : gpu_(std::move(gpu)), spread_(std::move(spread)), skip_(std::move(skip)) {}

    Gpu gpu_;
    vk::Kernel spread_, skip_;
    vk::Buffer planes_;  // shared::GridSkipArgs::occupied
};

/// Copies triangles, finds their bounds and shapes a grid over them.
class GridBounds {
public:
    static Result<GridBounds> create(const Gpu& gpu);
    /// Copies `count` triangles; their bounds are in work() behind the next barrier().
    void record(vk::Stream& stream, uint64_t from, uint64_t to, uint32_t count) const;
    /// Writes the shape of a grid of about `cells` cells into work(). Starts and ends without
    /// barrier.
    void shape(vk::Stream& stream, float cells) const;
    const vk::Buffer& work() const { return work_; }  ///< one shared::GridWork

private:
    GridBounds(vk::Kernel bounds, vk::Kernel shape, vk::Buffer work)
        : bounds_(std::move(bounds)), shape_(std::move(shape)), work_(std::move(work)) {}

    vk::Kernel bounds_, shape_;
    vk::Buffer work_;
};

/// Shapes the finest grid, up to the wanted number of cells, whose pairs are within pair_limit(),
/// over triangles whose bounds were recorded, and counts the pairs. finish()es the stream.
Result<GridLevel::Count> choose_shape(vk::Stream& stream, const GridBounds& bounds,
                                      GridLevel& level, TriangleSpan triangles,
                                      float cells_per_triangle);

inline uint64_t cell_count(uvec3 r) { return uint64_t{r.x} * r.y * r.z; }

/// The error of a build, saying of what.
Error about_grid(Error error, std::string_view what, uint64_t triangles);

}  // namespace aglow::accel::gpu
