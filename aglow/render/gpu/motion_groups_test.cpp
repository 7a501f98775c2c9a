// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/motion_groups.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

using namespace aglow;
using namespace aglow::render::gpu;
using accel::gpu::Motion;
using mesh::gpu::PartMotion;

namespace {

/// Parts with these numbers of triangles, each a node of its own; triangle i has vertices 3 i on.
Surfaces surfaces_of(const std::vector<uint32_t>& counts) {
    Surfaces surfaces;
    for (uint32_t i = 0; i < counts.size(); ++i) {
        SurfacePart part;
        part.node = static_cast<int>(i);
        part.first_triangle = static_cast<uint32_t>(surfaces.triangles.size());
        part.triangle_count = counts[i];
        for (uint32_t t = 0; t < counts[i]; ++t) {
            const auto first = static_cast<uint32_t>(3 * surfaces.triangles.size());
            surfaces.triangles.push_back({first, first + 1, first + 2});
            surfaces.part_of.push_back(i);
        }
        surfaces.parts.push_back(part);
    }
    surfaces.positions.resize(3 * surfaces.triangles.size());
    return surfaces;
}

}  // namespace

TEST_CASE("triangles that move alike lie together, and each is there once") {
    const Surfaces before = surfaces_of({2, 3, 1, 4, 5, 2});
    const std::vector<PartMotion> motions = {PartMotion::rigid,     PartMotion::still,
                                             PartMotion::deforming, PartMotion::still,
                                             PartMotion::rigid,     PartMotion::deforming};
    const MotionGroups grouped = motion_groups(before, motions, 8);
    REQUIRE(grouped.groups.size() == 4);
    CHECK(grouped.groups[0].motion == Motion::still);
    CHECK(grouped.groups[0].triangle_count == 7);
    CHECK(grouped.groups[1].motion == Motion::deforming);
    CHECK(grouped.groups[1].triangle_count == 3);
    CHECK(grouped.groups[2].motion == Motion::rigid);
    CHECK(grouped.part_of[2] == 4);  // the larger body first
    CHECK(grouped.part_of[3] == 0);

    std::vector<uint32_t> all = grouped.source_of;
    std::sort(all.begin(), all.end());
    std::vector<uint32_t> each(before.triangles.size());
    std::iota(each.begin(), each.end(), 0u);
    CHECK(all == each);
    const std::vector<uint32_t> place_of = grouped.place_of();
    const Surfaces& after = grouped.surfaces;
    for (uint32_t i = 0; i < all.size(); ++i) {
        CHECK(place_of[grouped.source_of[i]] == i);
        CHECK(after.triangles[i] == before.triangles[grouped.source_of[i]]);
        const SurfacePart& part = after.part(i);
        CHECK(&part == &after.parts[before.part_of[grouped.source_of[i]]]);
        CHECK(i - part.first_triangle < part.triangle_count);
    }
    uint32_t next = 0;
    for (const accel::gpu::Group& group : grouped.groups) {
        CHECK(group.first_triangle == next);
        next += group.triangle_count;
    }
    CHECK(next == all.size());
}

TEST_CASE("bodies beyond the limit deform, the smallest first") {
    const std::vector<PartMotion> motions(4, PartMotion::rigid);
    const MotionGroups grouped = motion_groups(surfaces_of({1, 5, 2, 4}), motions, 2);
    REQUIRE(grouped.groups.size() == 3);
    CHECK(grouped.groups[0].motion == Motion::deforming);
    CHECK(grouped.groups[0].triangle_count == 3);
    CHECK(grouped.part_of[1] == 1);
    CHECK(grouped.part_of[2] == 3);
}

TEST_CASE("primitives of one placed mesh are one body, and empty ones no group") {
    Surfaces surfaces = surfaces_of({2, 3, 0});
    surfaces.parts[1].node = surfaces.parts[0].node;
    const std::vector<PartMotion> motions = {PartMotion::rigid, PartMotion::rigid,
                                             PartMotion::still};
    const MotionGroups grouped = motion_groups(std::move(surfaces), motions, 8);
    REQUIRE(grouped.groups.size() == 1);
    CHECK(grouped.groups[0].triangle_count == 5);
    CHECK(motion_groups({}, {}, 8).groups.empty());
}
