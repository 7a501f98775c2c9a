// SPDX-License-Identifier: Apache-2.0
// What grids hold, against builds on the host.
#include "aglow/accel/gpu/testing/grid_harness.h"
#include "aglow/accel/gpu/testing/grid_scenes.h"
#include "aglow/shared/grid2.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

using namespace aglow;
using namespace aglow::accel::gpu;
using shared::kEmptyCell;
using shared::kLastReference;

namespace {

uint32_t cells_in(uvec3 r) { return r.x * r.y * r.z; }

uvec3 cell_of(uint32_t index, uvec3 r) {
    return {index % r.x, index / r.x % r.y, index / r.x / r.y};
}

/// Triangles of each cell, from words and references as a traversal reads them.
std::vector<std::vector<uint32_t>> contents(const std::vector<uint32_t>& cells,
                                            const std::vector<uint32_t>& references) {
    std::vector<std::vector<uint32_t>> result(cells.size());
    for (size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] & kEmptyCell) continue;
        for (uint32_t at = cells[i];; ++at) {
            REQUIRE(at < references.size());
            result[i].push_back(references[at] & ~kLastReference);
            if (references[at] & kLastReference) break;
        }
    }
    return result;
}

/// Checks one cell: triangles that overlap it are in it once, those that miss it by three margins
/// are not. `lower` and `size` in units in which the triangles' corners are given.
void check_cell(const std::vector<uint32_t>& in_cell, const Triangles& triangles, Vec3d lower,
                double size, double margin) {
    std::vector<uint32_t> sorted = in_cell;
    std::sort(sorted.begin(), sorted.end());
    REQUIRE(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const bool is_in = std::binary_search(sorted.begin(), sorted.end(), i);
        const bool usable = shared::is_usable_triangle(triangles[i]);
        const Vec3d box = {size, size, size};
        if (usable && overlaps_box(triangles[i], lower, box, 0)) REQUIRE(is_in);
        if (!usable || !overlaps_box(triangles[i], lower, box, 3 * margin)) REQUIRE_FALSE(is_in);
    }
}

Triangles in_cells(const Triangles& triangles, const shared::GridShape& s) {
    Triangles result;
    for (const Triangle& t : triangles) {
        result.push_back({(t.a - s.lower) * s.cells_per_length,
                          (t.b - s.lower) * s.cells_per_length,
                          (t.c - s.lower) * s.cells_per_length});
    }
    return result;
}

void check_grid(GridHarness& grid, const Triangles& triangles) {
    const auto header = grid.read<shared::GridHeader>(grid.structure().header(), 1)[0];
    const uvec3 r = header.shape.resolution;
    const StructureStats stats = grid.structure().stats();
    REQUIRE(stats.cells == cells_in(r));
    const auto cells = grid.read<uint32_t>(header.cells, stats.cells);
    const auto references = grid.read<uint32_t>(header.references, stats.references);
    const auto found = contents(cells, references);
    const Triangles scaled = in_cells(triangles, header.shape);
    const double margin = shared::grid_margin(shared::largest(shared::grid_extent(header.shape)));
    uint64_t count = 0;
    for (uint32_t i = 0; i < cells.size(); ++i) {
        const uvec3 at = cell_of(i, r);
        check_cell(found[i], scaled, {double(at.x), double(at.y), double(at.z)}, 1, margin);
        count += found[i].size();
    }
    CHECK(count == stats.references);
}

void check_two_levels(GridHarness& grid, const Triangles& triangles) {
    const auto header = grid.read<shared::Grid2Header>(grid.structure().header(), 1)[0];
    const uvec3 r = header.shape.resolution;
    const StructureStats stats = grid.structure().stats();
    const auto cells = grid.read<uint32_t>(header.cells, cells_in(r));
    const auto resolutions = grid.read<uint32_t>(header.leaf_resolutions, cells_in(r));
    const uint64_t leaf_count = stats.cells - cells_in(r);
    const auto leaves = grid.read<uint32_t>(header.leaf_cells, leaf_count);
    const auto references = grid.read<uint32_t>(header.references, stats.references);
    const auto found = contents(leaves, references);
    const Triangles scaled = in_cells(triangles, header.shape);
    uint64_t seen = 0;
    for (uint32_t i = 0; i < cells.size(); ++i) {
        const uvec3 at = cell_of(i, r);
        const Vec3d corner = {double(at.x), double(at.y), double(at.z)};
        if (cells[i] & kEmptyCell) {
            check_cell({}, scaled, corner, 1, 0);
            continue;
        }
        const uvec3 leaf_r = shared::unpacked_resolution(resolutions[i]);
        seen += cells_in(leaf_r);
        for (uint32_t k = 0; k < cells_in(leaf_r); ++k) {
            // In leaf cells, which have their own size along each axis.
            const uvec3 leaf = cell_of(k, leaf_r);
            const vec3 scale = {float(leaf_r.x), float(leaf_r.y), float(leaf_r.z)};
            const vec3 origin = {float(at.x), float(at.y), float(at.z)};
            Triangles local;
            for (const Triangle& t : scaled) {
                local.push_back(
                    {(t.a - origin) * scale, (t.b - origin) * scale, (t.c - origin) * scale});
            }
            const float finest =
                shared::largest(shared::grid_extent(header.shape)) * shared::largest(scale);
            check_cell(found[cells[i] + k], local, {double(leaf.x), double(leaf.y), double(leaf.z)},
                       1, shared::grid_margin(finest));
        }
    }
    CHECK(seen == leaf_count);
}

/// Distance from each cell to the nearest occupied one, by looking at all.
uint32_t distance(uvec3 from, const std::vector<uvec3>& occupied) {
    uint32_t best = 0xffffffff;
    for (uvec3 at : occupied) {
        auto apart = [](uint32_t a, uint32_t b) { return a > b ? a - b : b - a; };
        best = std::min(best,
                        std::max({apart(from.x, at.x), apart(from.y, at.y), apart(from.z, at.z)}));
    }
    return best;
}

/// The largest step known to be safe: 1, 2, 3, 5, 9 or 17, the largest not above the distance.
uint32_t step_below(uint32_t distance) {
    for (uint32_t step : {17u, 9u, 5u, 3u, 2u}) {
        if (distance >= step) return step;
    }
    return 1;
}

}  // namespace

TEST_CASE("each triangle is in exactly the cells of the uniform grid that it overlaps") {
    vk::TestDevice device;
    if (!device) return;
    GridHarness grid(device.gpu(), shared::kStructureGrid);
    for (const Triangles& triangles :
         {soup(300, 0.05f, 1), soup(100, 0.7f, 2), sphere({1, 2, 3}, 5, 16, 8), cube(-1, 1),
          joined(soup(200, 0.01f, 3), {{{-9, 0.5f, -9}, {9, 0.5f, -9}, {0, 0.6f, 9}}}),
          moved(soup(200, 0.1f, 4), {1e6f, 0, 0}), soup(1, 0.5f, 5)}) {
        CAPTURE(triangles.size());
        REQUIRE(grid.build(triangles));
        check_grid(grid, triangles);
    }
}

TEST_CASE("each triangle is in exactly the leaf cells of the two-level grid that it overlaps") {
    vk::TestDevice device;
    if (!device) return;
    GridHarness grid(device.gpu(), shared::kStructureGrid2);
    for (const Triangles& triangles :
         {soup(300, 0.05f, 1), soup(60, 0.7f, 2), sphere({1, 2, 3}, 5, 16, 8), cube(-1, 1),
          joined(soup(200, 0.01f, 3), {{{-9, 0.5f, -9}, {9, 0.5f, -9}, {0, 0.6f, 9}}})}) {
        CAPTURE(triangles.size());
        REQUIRE(grid.build(triangles));
        check_two_levels(grid, triangles);
    }
}

TEST_CASE("a triangle over very many cells is shared by many work items") {
    vk::TestDevice device;
    if (!device) return;
    // 40 x 40 x 40 cells, so the large triangles have over a thousand columns.
    const Triangles large = {{{0, 0, 0.31f}, {1, 0, 0.33f}, {0, 1, 0.35f}},
                             {{0, 0, 0}, {1, 1, 0}, {1, 1, 1}},
                             {{0.5f, 0, 0}, {0.5f, 1, 0}, {0.5f, 1, 1}}};
    const Triangles triangles = joined(joined(soup(8000, 0.01f, 1), large), soup(8000, 0.01f, 2));
    GridHarness grid(device.gpu(), shared::kStructureGrid);
    REQUIRE(grid.build(triangles));
    const auto header = grid.read<shared::GridHeader>(grid.structure().header(), 1)[0];
    const StructureStats stats = grid.structure().stats();
    const auto found = contents(grid.read<uint32_t>(header.cells, stats.cells),
                                grid.read<uint32_t>(header.references, stats.references));
    const Triangles scaled = in_cells(large, header.shape);
    uint32_t overlaps = 0;
    for (uint32_t i = 0; i < found.size(); ++i) {
        std::vector<uint32_t> of_large;
        for (uint32_t triangle : found[i]) {
            if (triangle >= 8000 && triangle < 8003) of_large.push_back(triangle - 8000);
        }
        overlaps += static_cast<uint32_t>(of_large.size());
        const uvec3 at = cell_of(i, header.shape.resolution);
        check_cell(of_large, scaled, {double(at.x), double(at.y), double(at.z)}, 1,
                   shared::grid_margin(40));
    }
    CHECK(overlaps > 2000);
}

TEST_CASE("empty cells know how far the next occupied one is") {
    vk::TestDevice device;
    if (!device) return;
    GridHarness grid(device.gpu(), shared::kStructureGrid);
    // Few small triangles in one corner and the far one make most of a grid of 37 x 21 x 9 empty.
    for (vec3 size : {vec3{3.7f, 2.1f, 0.9f}, vec3{1, 7, 1}, vec3{1, 1, 0}}) {
        Triangles triangles;
        for (const Triangle& t : soup(3000, 0.002f, 1)) {
            triangles.push_back({t.a * 0.05f, t.b * 0.05f, t.c * 0.05f});
        }
        triangles.push_back({size, size * 0.999f, size - vec3{0.001f, 0, 0}});
        for (Triangle& t : triangles) t = {t.a * size, t.b * size, t.c * size};
        REQUIRE(grid.build(triangles));
        const auto header = grid.read<shared::GridHeader>(grid.structure().header(), 1)[0];
        const uvec3 r = header.shape.resolution;
        const auto cells = grid.read<uint32_t>(header.cells, cells_in(r));
        std::vector<uvec3> occupied;
        for (uint32_t i = 0; i < cells.size(); ++i) {
            if (!(cells[i] & kEmptyCell)) occupied.push_back(cell_of(i, r));
        }
        // Levels end where they span the grid.
        const uint32_t longest = std::max({r.x, r.y, r.z});
        uint32_t far = 0;
        for (uint32_t i = 0; i < cells.size(); ++i) {
            if (!(cells[i] & kEmptyCell)) continue;
            const uint32_t d = distance(cell_of(i, r), occupied);
            const uint32_t step = cells[i] & ~kEmptyCell;
            REQUIRE(step == std::min(step_below(d), step_below(longest)));
            far = std::max(far, step);
        }
        CHECK(far == 17);
    }
}

TEST_CASE("a scene that would fill too fine a grid gets a coarser one") {
    vk::TestDevice device;
    if (!device) return;
    for (uint32_t kind : {shared::kStructureGrid, shared::kStructureGrid2}) {
        GridHarness grid(device.gpu(), kind);
        // Each triangle reaches across the scene: pairs would be thousands for each.
        const Triangles triangles = soup(20000, 1.0f, 1);
        REQUIRE(grid.build(triangles));
        CHECK(grid.structure().stats().references <= (1 << 20));
        CHECK(grid.structure().stats().bytes < 20000u * 36 + (2 << 22));
    }
}

TEST_CASE("the same triangles make the same grid, whatever was built before") {
    vk::TestDevice device;
    if (!device) return;
    const Triangles triangles = joined(soup(3000, 0.05f, 7), {{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}});
    auto words = [&](GridHarness& grid) {
        const auto header = grid.read<shared::GridHeader>(grid.structure().header(), 1)[0];
        const StructureStats stats = grid.structure().stats();
        auto all = grid.read<uint32_t>(header.cells, stats.cells);
        const auto references = grid.read<uint32_t>(header.references, stats.references);
        all.insert(all.end(), references.begin(), references.end());
        return all;
    };
    GridHarness fresh(device.gpu(), shared::kStructureGrid);
    REQUIRE(fresh.build(triangles));
    GridHarness used(device.gpu(), shared::kStructureGrid);
    for (uint32_t count : {20000u, 0u, 10u}) REQUIRE(used.build(soup(count, 0.1f, count)));
    REQUIRE(used.build(triangles));
    CHECK(words(fresh) == words(used));
}

TEST_CASE("a build without memory says what it needs, and works once there is some") {
    const Triangles triangles = soup(2000, 0.05f, 1);
    for (uint32_t kind : {shared::kStructureGrid, shared::kStructureGrid2}) {
        int first = 0, last = 0;
        {
            vk::TestDevice device;
            if (!device) return;
            GridHarness grid(device.gpu(), kind);
            first = device->allocation_count();
            REQUIRE(grid.build(triangles));
            last = device->allocation_count();
        }
        REQUIRE(last - first > 10);
        for (int n = first; n < last; n += (last - first) / 5) {
            vk::DeviceOptions options;
            options.faults.fail_allocation = n;
            vk::TestDevice device(options);
            GridHarness grid(device.gpu(), kind);
            const Status status = grid.build(triangles);
            REQUIRE_FALSE(status);
            CHECK(status.error().code == Errc::out_of_memory);
            CHECK(status.error().message.find("bytes") != std::string::npos);
            CHECK(grid.structure().stats().references == 0);
            grid.renew_stream();
            REQUIRE(grid.build(triangles));
            CHECK(grid.structure().stats().references > 2000);
        }
    }
}
