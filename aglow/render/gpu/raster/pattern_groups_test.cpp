// SPDX-License-Identifier: Apache-2.0
// How groups of mesh shaders share patterns, without a device.
#include "aglow/refine/pattern.h"
#include "aglow/shared/pattern_group.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>

using namespace aglow;

namespace {

using Triangle = std::array<uint32_t, 3>;  // steps of its corners, in their order, the least first

Triangle sorted(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// As adaptive.glsl has it.
uint32_t folded(uint32_t steps, uint32_t segments) {
    const uint32_t i = std::min(steps & 0xffffu, segments);
    return i + (std::min(steps >> 16, segments - i) << 16);
}

int64_t area(const Triangle& t) {
    const auto x = [&](size_t k) { return static_cast<int64_t>(t[k] & 0xffffu); };
    const auto y = [&](size_t k) { return static_cast<int64_t>(t[k] >> 16); };
    return (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0));
}

}  // namespace

TEST_CASE("the tiles of a pattern have each of its triangles once, what is folded has no area") {
    const Pattern nested = nested_triangle_pattern(kMostAdaptiveSegments);
    for (uint32_t n = 1; n <= kMostAdaptiveSegments; ++n) {
        CAPTURE(n);
        const shared::PatternGroups groups = shared::pattern_groups(n);
        const uint32_t s = groups.segments;
        REQUIRE(groups.sides * s >= n);
        REQUIRE(groups.tiles >= 1);
        CHECK(groups.tiles * s * s <= shared::kGroupTriangles);
        CHECK(groups.tiles * (s + 1) * (s + 2) / 2 <= shared::kGroupVertices);
        std::set<Triangle> seen;
        for (uint32_t tile = 0; tile < groups.sides * groups.sides; ++tile) {
            const uvec3 corners = nested.triangles[tile];
            const auto place = [&](uint32_t v) {
                return folded(shared::tile_steps(nested.steps[corners.x], nested.steps[corners.y],
                                                 nested.steps[corners.z], nested.steps[v], s),
                              n);
            };
            for (uint32_t t = 0; t < s * s; ++t) {
                const uvec3 triangle = nested.triangles[t];
                const Triangle placed = {place(triangle.x), place(triangle.y), place(triangle.z)};
                if (area(placed) == 0) continue;
                CHECK(area(placed) == 1);  // counter-clockwise
                CHECK(seen.insert(sorted(placed)).second);
            }
        }
        std::set<Triangle> wanted;
        for (uint32_t t = 0; t < n * n; ++t) {
            const uvec3 triangle = nested.triangles[t];
            wanted.insert(sorted(
                {nested.steps[triangle.x], nested.steps[triangle.y], nested.steps[triangle.z]}));
        }
        CHECK(seen == wanted);
    }
}
