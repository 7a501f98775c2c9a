// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/grid/grid_cells.comp.h"
#include "aglow/accel/gpu/grid/grid_level.h"
#include "aglow/accel/gpu/structure.h"
#include "aglow/shared/structure.h"

#include <array>
#include <span>

namespace aglow::accel::gpu {

using shared::GridHeader;
using shared::kGridGroupSize;

namespace {

// Cells per triangle. Rays are fastest between 4 and 8 in scenes of even density; 8 costs a quarter
// more build and memory.
constexpr float kCellsPerTriangle = 4;

/// What all grids of a scene share.
struct GridTools {
    GridBounds bounds;
    GridLevel level;
    GridSkips skips;
    vk::Kernel cells;
};

class Grid final : public Structure {
public:
    Grid(Gpu gpu, std::shared_ptr<GridTools> tools)
        : gpu_(std::move(gpu)), tools_(std::move(tools)) {}

    uint32_t kind() const override { return shared::kStructureGrid; }
    Status build(vk::Stream& stream, TriangleSpan triangles) override;
    std::unique_ptr<Structure> sibling() const override {
        return std::make_unique<Grid>(gpu_, tools_);
    }
    uint64_t header() const override { return header_.address(); }
    StructureStats stats() const override { return stats_; }

private:
    Status fill(vk::Stream& stream, TriangleSpan triangles);
    Status write_header(vk::Stream& stream, const shared::GridShape& shape);

    Gpu gpu_;
    std::shared_ptr<GridTools> tools_;
    vk::Buffer header_, triangles_, cells_, references_;
    StructureStats stats_;
};

Status Grid::build(vk::Stream& stream, TriangleSpan triangles) {
    stats_ = {};
    Status built = fill(stream, triangles);
    if (built) return built;
    header_ = vk::Buffer();
    return tl::unexpected(about_grid(std::move(built).error(), "uniform grid", triangles.count));
}

Status Grid::fill(vk::Stream& stream, TriangleSpan triangles) {
    GridTools& tools = *tools_;
    stream.barrier();
    AG_CHECK(gpu_->grow(header_, sizeof(GridHeader), "grid header"));
    if (triangles.count == 0) return write_header(stream, {});
    const uint64_t triangle_bytes = uint64_t{triangles.count} * sizeof(shared::Triangle);
    if (triangle_bytes > triangles_.size()) AG_CHECK(stream.finish());  // rays may still read them
    AG_CHECK(gpu_->grow(triangles_, triangle_bytes, "grid triangles"));
    tools.bounds.record(stream, triangles.address, triangles_.address(), triangles.count);
    AG_TRY(const GridLevel::Count count,
           choose_shape(stream, tools.bounds, tools.level, {triangles_.address(), triangles.count},
                        kCellsPerTriangle));
    const shared::GridShape& shape = count.work.shape;
    if (count.pairs == 0) return write_header(stream, {});

    const uint64_t cells = cell_count(shape.resolution);
    AG_CHECK(gpu_->grow(cells_, cells * 4, "grid cells"));
    AG_CHECK(gpu_->grow(references_, count.pairs * 4, "grid references"));
    AG_CHECK(tools.skips.start(stream, shape.resolution));
    AG_TRY(const vk::Sorted sorted, tools.level.sort(stream, count.pairs, cells));
    stream.run(tools.cells,
               shared::GridCellsArgs{.first_group = 0,
                                     .count = static_cast<uint32_t>(count.pairs),
                                     .keys = sorted.keys,
                                     .values = sorted.values,
                                     .cells = cells_.address(),
                                     .ends = 0,
                                     .references = references_.address(),
                                     .occupied = tools.skips.occupied(),
                                     .resolution = shape.resolution},
               vk::group_count(count.pairs, kGridGroupSize));
    stream.barrier();
    tools.skips.record(stream, cells_.address(), shape.resolution);
    stats_.references = count.pairs;
    stats_.cells = cells;
    stats_.bytes = sizeof(GridHeader) + triangle_bytes + 4 * (cells + count.pairs);
    return write_header(stream, shape);
}

Status Grid::write_header(vk::Stream& stream, const shared::GridShape& shape) {
    const GridHeader header = {.triangles = triangles_.address(),
                               .cells = cells_.address(),
                               .references = references_.address(),
                               .shape = shape};
    stream.upload(std::span(&header, 1), header_);
    return {};
}

}  // namespace

Result<std::unique_ptr<Structure>> make_grid(const Gpu& gpu) {
    AG_TRY(auto bounds, GridBounds::create(gpu));
    AG_TRY(auto level, GridLevel::create(gpu, shared::kGridOneLevel));
    AG_TRY(auto skips, GridSkips::create(gpu));
    const std::array<uint32_t, 1> constants = {shared::kGridOneLevel};
    AG_TRY(auto cells, vk::Kernel::create(gpu, "grid cells", shaders::grid_cells_comp, constants));
    auto tools = std::make_shared<GridTools>(
        GridTools{std::move(bounds), std::move(level), std::move(skips), std::move(cells)});
    return std::make_unique<Grid>(gpu, std::move(tools));
}

}  // namespace aglow::accel::gpu
