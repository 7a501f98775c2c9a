// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/grid/grid2_leaves.comp.h"
#include "aglow/accel/gpu/grid/grid_cells.comp.h"
#include "aglow/accel/gpu/grid/grid_level.h"
#include "aglow/accel/gpu/structure.h"
#include "aglow/shared/structure.h"

#include <array>
#include <cstddef>
#include <span>

namespace aglow::accel::gpu {

using shared::Grid2Header;
using shared::kGridGroupSize;

namespace {

// Cells per triangle of the first level, as in Kalojanov, Billeter & Slusallek; and per pair of the
// second, which they make 2.4. With 4, rays test a third less triangles for a fifth more memory.
constexpr float kCellsPerTriangle = 0.12f;
constexpr float kLeavesPerPair = 4;

/// What all two-level grids of a scene share.
struct Grid2Tools {
    GridBounds bounds;
    GridLevel first, second;
    GridSkips skips;
    vk::Scan scan;
    vk::Kernel first_cells, second_cells, leaves;
    vk::Buffer begins, ends, leaf_counts;  // of the first level's cells
};

/// A level's pairs in order of cells.
struct Pairs {
    vk::Sorted sorted;
    uint64_t count = 0;
};

class Grid2 final : public Structure {
public:
    Grid2(Gpu gpu, std::shared_ptr<Grid2Tools> tools)
        : gpu_(std::move(gpu)), tools_(std::move(tools)) {}

    uint32_t kind() const override { return shared::kStructureGrid2; }
    Status build(vk::Stream& stream, TriangleSpan triangles) override;
    std::unique_ptr<Structure> sibling() const override {
        return std::make_unique<Grid2>(gpu_, tools_);
    }
    uint64_t header() const override { return header_.address(); }
    StructureStats stats() const override { return stats_; }

private:
    Status fill(vk::Stream& stream, TriangleSpan triangles);
    Status reserve_cells(uint64_t cells);
    void find_cells(vk::Stream& stream, const Pairs& pairs, uvec3 resolution);
    Result<GridLevel::Count> choose_leaves(vk::Stream& stream, const Pairs& first, uint64_t cells,
                                           uint32_t triangle_count);
    Status fill_leaves(vk::Stream& stream, const GridLevel::Count& count);
    Status write_header(vk::Stream& stream, const shared::GridShape& shape);

    Gpu gpu_;
    std::shared_ptr<Grid2Tools> tools_;
    vk::Buffer header_, triangles_, cells_, leaf_resolutions_, leaf_cells_, references_;
    StructureStats stats_;
};

Status Grid2::build(vk::Stream& stream, TriangleSpan triangles) {
    stats_ = {};
    Status built = fill(stream, triangles);
    if (built) return built;
    header_ = vk::Buffer();
    return tl::unexpected(about_grid(std::move(built).error(), "two-level grid", triangles.count));
}

Status Grid2::fill(vk::Stream& stream, TriangleSpan triangles) {
    Grid2Tools& tools = *tools_;
    stream.barrier();
    AG_CHECK(gpu_->grow(header_, sizeof(Grid2Header), "grid header"));
    if (triangles.count == 0) return write_header(stream, {});
    const uint64_t triangle_bytes = uint64_t{triangles.count} * sizeof(shared::Triangle);
    if (triangle_bytes > triangles_.size()) AG_CHECK(stream.finish());  // rays may still read them
    AG_CHECK(gpu_->grow(triangles_, triangle_bytes, "grid triangles"));
    tools.bounds.record(stream, triangles.address, triangles_.address(), triangles.count);
    AG_TRY(const GridLevel::Count first,
           choose_shape(stream, tools.bounds, tools.first, {triangles_.address(), triangles.count},
                        kCellsPerTriangle));
    if (first.pairs == 0) return write_header(stream, {});

    const shared::GridShape& shape = first.work.shape;
    const uint64_t cells = cell_count(shape.resolution);
    AG_CHECK(reserve_cells(cells));
    AG_CHECK(tools.skips.start(stream, shape.resolution));
    stream.fill(tools.ends, 0, 0, cells * 4);
    AG_TRY(const vk::Sorted sorted, tools.first.sort(stream, first.pairs, cells));
    const Pairs pairs = {sorted, first.pairs};
    find_cells(stream, pairs, shape.resolution);
    AG_TRY(const GridLevel::Count second, choose_leaves(stream, pairs, cells, triangles.count));
    tools.skips.record(stream, cells_.address(), shape.resolution);
    AG_CHECK(fill_leaves(stream, second));
    stats_.references = second.pairs;
    stats_.cells = cells + second.work.leaf_cells;
    stats_.bytes = sizeof(Grid2Header) + triangle_bytes +
                   4 * (2 * cells + second.work.leaf_cells + second.pairs);
    return write_header(stream, shape);
}

Status Grid2::reserve_cells(uint64_t cells) {
    Grid2Tools& tools = *tools_;
    AG_CHECK(gpu_->grow(cells_, cells * 4, "grid cells"));
    AG_CHECK(gpu_->grow(leaf_resolutions_, cells * 4, "grid resolutions of cells"));
    AG_CHECK(gpu_->grow(tools.begins, cells * 4, "grid begins of cells"));
    AG_CHECK(gpu_->grow(tools.ends, cells * 4, "grid ends of cells"));
    AG_CHECK(gpu_->grow(tools.leaf_counts, cells * 4, "grid leaf counts"));
    return tools.scan.reserve(cells);
}

/// Which pairs belong to each cell of the first level.
void Grid2::find_cells(vk::Stream& stream, const Pairs& pairs, uvec3 resolution) {
    Grid2Tools& tools = *tools_;
    shared::GridCellsArgs args = {};
    args.count = static_cast<uint32_t>(pairs.count);
    args.keys = pairs.sorted.keys;
    args.values = pairs.sorted.values;
    args.cells = tools.begins.address();
    args.ends = tools.ends.address();
    args.occupied = tools.skips.occupied();
    args.resolution = resolution;
    stream.run(tools.first_cells, args, vk::group_count(pairs.count, kGridGroupSize));
    stream.barrier();
}

/// Gives each cell of the first level the finest grid, up to the wanted number of leaves, with
/// which all pairs are within reason; and counts them.
Result<GridLevel::Count> Grid2::choose_leaves(vk::Stream& stream, const Pairs& first,
                                              uint64_t cells, uint32_t triangle_count) {
    Grid2Tools& tools = *tools_;
    const vk::Buffer& work = tools.bounds.work();
    shared::GridPairsArgs jobs = {};
    jobs.job_count = static_cast<uint32_t>(first.count);
    jobs.triangles = triangles_.address();
    jobs.work = work.address();
    jobs.upper_keys = first.sorted.keys;
    jobs.upper_values = first.sorted.values;
    jobs.leaf_resolutions = leaf_resolutions_.address();
    jobs.leaf_bases = cells_.address();
    shared::Grid2LeavesArgs leaves = {};
    leaves.count = static_cast<uint32_t>(cells);
    leaves.work = work.address();
    leaves.begins = tools.begins.address();
    leaves.ends = tools.ends.address();
    leaves.leaf_resolutions = leaf_resolutions_.address();
    leaves.leaf_counts = tools.leaf_counts.address();
    for (leaves.per_triangle = kLeavesPerPair;; leaves.per_triangle /= 4) {
        stream.run(tools.leaves, leaves, vk::group_count(cells, kGridGroupSize));
        stream.barrier();
        tools.scan.record(stream, leaves.leaf_counts, cells_.address(), cells,
                          work.address() + offsetof(shared::GridWork, leaf_cells));
        AG_TRY(const GridLevel::Count count, tools.second.count(stream, work, jobs));
        if (count.pairs <= pair_limit(triangle_count)) return count;
    }
}

Status Grid2::fill_leaves(vk::Stream& stream, const GridLevel::Count& count) {
    Grid2Tools& tools = *tools_;
    const uint64_t leaves = count.work.leaf_cells;
    AG_CHECK(gpu_->grow(leaf_cells_, leaves * 4, "grid leaf cells"));
    AG_CHECK(gpu_->grow(references_, count.pairs * 4, "grid references"));
    stream.fill(leaf_cells_, shared::kEmptyCell | 1u, 0, leaves * 4);
    AG_TRY(const vk::Sorted sorted, tools.second.sort(stream, count.pairs, leaves));
    shared::GridCellsArgs args = {};
    args.count = static_cast<uint32_t>(count.pairs);
    args.keys = sorted.keys;
    args.values = sorted.values;
    args.cells = leaf_cells_.address();
    args.references = references_.address();
    stream.run(tools.second_cells, args, vk::group_count(count.pairs, kGridGroupSize));
    return {};
}

Status Grid2::write_header(vk::Stream& stream, const shared::GridShape& shape) {
    const Grid2Header header = {.triangles = triangles_.address(),
                                .cells = cells_.address(),
                                .leaf_resolutions = leaf_resolutions_.address(),
                                .leaf_cells = leaf_cells_.address(),
                                .references = references_.address(),
                                .shape = shape};
    stream.upload(std::span(&header, 1), header_);
    return {};
}

Result<vk::Kernel> cells_kernel(const Gpu& gpu, uint32_t level) {
    const std::array<uint32_t, 1> constants = {level};
    return vk::Kernel::create(gpu, "grid cells", shaders::grid_cells_comp, constants);
}

}  // namespace

Result<std::unique_ptr<Structure>> make_grid2(const Gpu& gpu) {
    AG_TRY(auto bounds, GridBounds::create(gpu));
    AG_TRY(auto first, GridLevel::create(gpu, shared::kGridFirstLevel));
    AG_TRY(auto second, GridLevel::create(gpu, shared::kGridSecondLevel));
    AG_TRY(auto skips, GridSkips::create(gpu));
    AG_TRY(auto scan, vk::Scan::create(gpu));
    AG_TRY(auto first_cells, cells_kernel(gpu, shared::kGridFirstLevel));
    AG_TRY(auto second_cells, cells_kernel(gpu, shared::kGridSecondLevel));
    AG_TRY(auto leaves, vk::Kernel::create(gpu, "grid leaves", shaders::grid2_leaves_comp));
    auto tools = std::make_shared<Grid2Tools>(
        Grid2Tools{std::move(bounds), std::move(first), std::move(second), std::move(skips),
                   std::move(scan), std::move(first_cells), std::move(second_cells),
                   std::move(leaves), vk::Buffer(), vk::Buffer(), vk::Buffer()});
    return std::make_unique<Grid2>(gpu, std::move(tools));
}

}  // namespace aglow::accel::gpu
