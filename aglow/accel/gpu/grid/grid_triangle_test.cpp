// SPDX-License-Identifier: Apache-2.0
// The formulas of shared/triangle.h and shared/triangle_box.h against independent ones in double
// precision.
#include "aglow/accel/gpu/testing/grid_reference.h"
#include "aglow/core/random.h"
#include "aglow/shared/grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace aglow;
using namespace aglow::accel::gpu;
using shared::CellTriangle;
using shared::Triangle;

namespace {

struct Cell {
    uint32_t x, y, z;
    auto operator<=>(const Cell&) const = default;
};

uint32_t component(vec3 v, uint32_t axis) {
    return static_cast<uint32_t>(axis == 0 ? v.x : axis == 1 ? v.y : v.z);
}

/// The cells that shared/triangle_box.h finds, column by column as the kernels do.
std::vector<Cell> cells_of(const CellTriangle& t) {
    std::vector<Cell> cells;
    const uint32_t to_x = t.axis == 0 ? 2 : t.axis == 1 ? 1 : 0;  // which permuted axis is x
    for (float y = 0; y < t.size.y; ++y) {
        for (float x = 0; x < t.size.x; ++x) {
            const auto range = shared::column_range(t, x, y);
            for (float z = range.x; z <= range.y; ++z) {
                if (!shared::overlaps_cell(t, x, y, z)) continue;
                const vec3 at = t.first + vec3{x, y, z};
                cells.push_back({component(at, to_x), component(at, (to_x + 1) % 3),
                                 component(at, (to_x + 2) % 3)});
            }
        }
    }
    std::sort(cells.begin(), cells.end());
    return cells;
}

/// Checks all cells of a grid: those that the triangle overlaps must be found, those it misses by
/// three margins must not.
void check_cells(const Triangle& t, uint32_t size) {
    const auto cells = static_cast<float>(size);
    const float margin = shared::grid_margin(cells);
    const auto found =
        cells_of(shared::cell_triangle(t.a, t.b, t.c, {cells, cells, cells}, margin));
    for (uint32_t z = 0; z < size; ++z) {
        for (uint32_t y = 0; y < size; ++y) {
            for (uint32_t x = 0; x < size; ++x) {
                const bool is_found = std::binary_search(found.begin(), found.end(), Cell{x, y, z});
                const Vec3d at = {double(x), double(y), double(z)};
                if (overlaps_box(t, at, {1, 1, 1}, 0)) REQUIRE(is_found);
                if (!overlaps_box(t, at, {1, 1, 1}, 3 * margin)) REQUIRE_FALSE(is_found);
            }
        }
    }
}

}  // namespace

TEST_CASE("a triangle seen edge-on is in its cells however its corners are rounded") {
    Pcg32 random(5);
    const auto rounded = [&](float v) {
        for (int ulps = static_cast<int>(random.next() % 4); ulps > 0; --ulps)
            v = std::nextafter(v, random.next() % 2 == 0 ? 0.0f : 12.0f);
        return v;
    };
    for (int i = 0; i < 600; ++i) {
        const vec3 a = random_vector(random, 1, 11), c = random_vector(random, 1, 11);
        Triangle t{{i % 2 == 0 ? a.x : c.x, c.y, c.z}, a, {c.x, a.y, a.z}};
        for (vec3* p : {&t.a, &t.b, &t.c}) {
            *p = {rounded(p->x), rounded(p->y), rounded(p->z)};
            if (i % 3 == 1) *p = {p->y, p->z, p->x};
            if (i % 3 == 2) *p = {p->z, p->x, p->y};
        }
        check_cells(t, 12);
    }
}

TEST_CASE("a triangle is in exactly the cells it overlaps") {
    Pcg32 random(1);
    for (int i = 0; i < 600; ++i) {
        const float extent = i % 3 == 0 ? 1.5f : i % 3 == 1 ? 6.0f : 12.0f;
        const vec3 a = random_vector(random, 0, 12);
        Triangle t{a, a + random_vector(random, -extent, extent),
                   a + random_vector(random, -extent, extent)};
        for (vec3* p : {&t.b, &t.c}) {
            p->x = shared::clamp(p->x, 0.0f, 12.0f);
            p->y = shared::clamp(p->y, 0.0f, 12.0f);
            p->z = shared::clamp(p->z, 0.0f, 12.0f);
        }
        check_cells(t, 12);
    }
}

TEST_CASE("triangles on cell boundaries, slivers and lines are in all cells they touch") {
    check_cells({{0, 0, 5}, {12, 0, 5}, {0, 12, 5}}, 12);
    check_cells({{4, 0, 0}, {4, 12, 0}, {4, 0, 12}}, 12);
    check_cells({{0, 0, 0}, {12, 12, 12}, {12, 12, 11.9999f}}, 12);
    check_cells({{0, 0, 0}, {12, 12, 12}, {6, 6, 6.00001f}}, 12);
    check_cells({{0.5f, 0.5f, 0.5f}, {11.5f, 11.5f, 11.5f}, {3.5f, 3.5f, 3.5f}}, 12);
    check_cells({{3, 3, 0}, {3, 3, 12}, {3, 3, 6}}, 12);
    // Collinear, of no area at all, and mostly outside of the grid.
    check_cells({{-40, -40, -40}, {50, 50, 50}, {5, 5, 5}}, 12);
    check_cells({{-40, -20, 3}, {60, 30, 3}, {0, 0, 3}}, 12);
    check_cells({{3, 3, 3}, {3.0001f, 3, 3}, {3, 3.0001f, 3}}, 12);
}

TEST_CASE("two triangles of an edge let no ray through between them") {
    Pcg32 random(2);
    int through_edge = 0;
    for (int i = 0; i < 200000; ++i) {
        const vec3 a = random_vector(random, -1, 1);
        const vec3 b = random_vector(random, -1, 1);
        // Apexes on both sides of the edge as the ray sees it.
        const vec3 origin = random_vector(random, -1, 1) * 3.0f;
        const vec3 on_edge = shared::mix(a, b, random.uniform());
        const vec3 direction = on_edge - origin;
        const vec3 side = shared::cross(direction, b - a);
        if (shared::length(side) < 0.1f) continue;
        const Triangle left{a, b, on_edge + side};
        const Triangle right{b, a, on_edge - side};
        const auto ray = shared::sheared_ray(origin, direction);
        through_edge++;
        const bool hit = shared::intersect_triangle(ray, left, 0, 2).hit != 0 ||
                         shared::intersect_triangle(ray, right, 0, 2).hit != 0;
        REQUIRE(hit);
    }
    CHECK(through_edge > 100000);
}

TEST_CASE("hits lie where double precision finds them, with the weights of their corners") {
    Pcg32 random(3);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Triangle t{random_vector(random, -1, 1), random_vector(random, -1, 1),
                         random_vector(random, -1, 1)};
        const vec3 origin = random_vector(random, -2, 2);
        const vec3 direction = random_vector(random, -1, 1) - origin;
        const auto found =
            shared::intersect_triangle(shared::sheared_ray(origin, direction), t, 0, 1e30f);
        const DoubleHit exact = intersect_exactly(t, origin, direction);
        if (exact.edge_distance < 1e-5 || exact.facing < 1e-3) continue;  // a matter of rounding
        REQUIRE((found.hit != 0) == (exact.inside && exact.t > 0));
        if (found.hit == 0) continue;
        ++hits;
        CHECK(std::abs(found.t - exact.t) <= 1e-4 * exact.t + 1e-6);
        CHECK(std::abs(found.barycentrics.x - exact.v) < 1e-3);
        CHECK(std::abs(found.barycentrics.y - exact.w) < 1e-3);
    }
    CHECK(hits > 5000);
}

TEST_CASE("degenerate, edge-on and broken triangles are hit by nothing") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto ray = shared::sheared_ray({0.25f, 0.25f, -1}, {0, 0, 1});
    const Triangle good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(shared::intersect_triangle(ray, good, 0, 10).hit == 1);
    CHECK(shared::intersect_triangle(ray, good, 0, 1).hit == 0);  // far is not reached
    CHECK(shared::intersect_triangle(ray, good, 1, 10).hit == 0);
    const Triangle bad[] = {{{0, 0, 0}, {1, 1, 0}, {1, 1, 0}},
                            {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                            {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                            {{0, 0, nan}, {1, 0, 0}, {0, 1, 0}},
                            {{kInfinity, 0, 0}, {-1, -1, 0}, {0, 1, 0}},
                            {{0, 0, 0}, {kInfinity, 0, 0}, {0, kInfinity, 0}}};
    for (const Triangle& t : bad) {
        CHECK_FALSE(shared::is_usable_triangle(t));
        CHECK(shared::intersect_triangle(ray, t, 0, 10).hit == 0);
    }
    CHECK(shared::is_usable_triangle(good));
    const Triangle edge_on{{0.25f, 0, 0}, {0.25f, 1, 0}, {0.25f, 0, 1}};
    CHECK(shared::is_usable_triangle(edge_on));
    CHECK(shared::intersect_triangle(ray, edge_on, 0, 10).hit == 0);
}

TEST_CASE("a grid has about as many cells as it is asked for, of one shape, in boxes of any kind") {
    auto shape = [](vec3 size, float cells) {
        const vec3 at = {10, -20, 30};
        return shared::grid_shape({at, at + size}, cells);
    };
    CHECK(shape({1, 1, 1}, 1000).resolution == uvec3{10, 10, 10});
    CHECK(shape({2, 1, 1}, 2000).resolution == uvec3{20, 10, 10});
    CHECK(shape({1, 1, 0}, 100).resolution == uvec3{10, 10, 1});
    CHECK(shape({0, 4, 1}, 400).resolution == uvec3{1, 40, 10});
    CHECK(shape({0, 0, 7}, 100).resolution == uvec3{1, 1, 100});
    CHECK(shape({0, 0, 0}, 100).resolution == uvec3{1, 1, 1});
    CHECK(shape({1, 1, 1e-6f}, 100).resolution == uvec3{10, 10, 1});  // flat but for rounding
    CHECK(shape({1, 1e-6f, 1e-6f}, 1e6f).resolution == uvec3{shared::kMaxGridAxis, 1, 1});
    CHECK(shape({1, 1, 1}, 0.1f).resolution == uvec3{1, 1, 1});

    Pcg32 random(4);
    for (int i = 0; i < 1000; ++i) {
        const vec3 size = {std::pow(10.0f, random.uniform() * 8 - 4),
                           std::pow(10.0f, random.uniform() * 8 - 4),
                           std::pow(10.0f, random.uniform() * 8 - 4)};
        const auto s = shape(size, 1e5f);
        CHECK(uint64_t{s.resolution.x} * s.resolution.y * s.resolution.z <= 100001);
        // All of the box is inside, away from the outer faces.
        const vec3 low = (vec3{10, -20, 30} - s.lower) * s.cells_per_length;
        const vec3 high = (vec3{10, -20, 30} + size - s.lower) * s.cells_per_length;
        const vec3 cells = shared::grid_extent(s);
        CHECK(std::min({low.x, low.y, low.z}) > 0.01f);
        CHECK(std::min({cells.x - high.x, cells.y - high.y, cells.z - high.z}) > 0.01f);
    }
}
