// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/pattern.h"

#include <doctest/doctest.h>

namespace aglow {
namespace {

double signed_area(const Pattern& pattern, uvec3 t) {
    const vec2 a = pattern.coordinates[t.x], b = pattern.coordinates[t.y],
               c = pattern.coordinates[t.z];
    return 0.5 * (double(b.x - a.x) * double(c.y - a.y) - double(c.x - a.x) * double(b.y - a.y));
}

void check_covers(const Pattern& pattern, double whole) {
    double sum = 0;
    for (const uvec3 t : pattern.triangles) {
        CHECK(signed_area(pattern, t) > 0);
        sum += signed_area(pattern, t);
    }
    CHECK(sum == doctest::Approx(whole).epsilon(1e-5));
}

TEST_CASE("a pattern covers its polygon once with triangles that run counter-clockwise") {
    for (const int n : {1, 2, 3, 7, 16, 256}) {
        const size_t count = static_cast<size_t>(n);
        const Pattern triangle = triangle_pattern(n);
        CHECK(triangle.coordinates.size() == (count + 1) * (count + 2) / 2);
        CHECK(triangle.triangles.size() == count * count);
        check_covers(triangle, 0.5);
        const Pattern quad = quad_pattern(n);
        CHECK(quad.coordinates.size() == (count + 1) * (count + 1));
        CHECK(quad.triangles.size() == 2 * count * count);
        check_covers(quad, 1);
    }
}

TEST_CASE("a nested pattern begins with all smaller ones") {
    const Pattern nested = nested_triangle_pattern(64);
    for (const int n : {1, 2, 3, 7, 16, 64}) {
        const size_t count = static_cast<size_t>(n);
        Pattern own;
        own.triangles.assign(nested.triangles.begin(),
                             nested.triangles.begin() + static_cast<ptrdiff_t>(count * count));
        for (size_t v = 0; v < (count + 1) * (count + 2) / 2; ++v) {
            const auto i = static_cast<float>(nested.steps[v] & 0xffffu),
                       j = static_cast<float>(nested.steps[v] >> 16);
            own.coordinates.push_back({i / static_cast<float>(n), j / static_cast<float>(n)});
        }
        for (const uvec3 t : own.triangles)
            for (const uint32_t v : {t.x, t.y, t.z}) {
                REQUIRE(v < own.coordinates.size());
                CHECK(own.coordinates[v].x + own.coordinates[v].y <= 1.00001f);
            }
        check_covers(own, 0.5);
    }
}

}  // namespace
}  // namespace aglow
