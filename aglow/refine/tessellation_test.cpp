// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tessellation.h"

#include "aglow/refine/pattern.h"
#include "aglow/refine/testing/patch_meshes.h"
#include "aglow/shared/pattern.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

using Kind = Tessellation::Levels;

/// Every edge of the triangles is met once from each side; those of only one side are on the
/// boundary of the mesh, where it has as many segments as its edges ask for.
void check_closed(const Topology& topology, const Tessellation& t) {
    std::map<std::pair<uint32_t, uint32_t>, int> sides;
    std::set<uint32_t> used;
    for (const uvec3 v : t.triangles)
        for (const auto& [a, b] : {std::pair(v.x, v.y), std::pair(v.y, v.z), std::pair(v.z, v.x)}) {
            ++sides[{a, b}];
            used.insert(a);
        }
    size_t open = 0, expected = 0;
    for (const auto& [edge, count] : sides) {
        CHECK(count == 1);
        open += sides.contains({edge.second, edge.first}) ? 0 : 1;
    }
    for (uint32_t e = 0; e < topology.edge_count(); ++e)
        if (topology.twin[topology.edge_half[e]] == kNone)
            expected += shared::edge_segments(t.edge_level[e], static_cast<uint32_t>(t.levels));
    CHECK(open == expected);
    CHECK(used.size() == t.vertex_count());
}

TEST_CASE("refined meshes are closed where the mesh is, and use every vertex") {
    const PatchMesh ball = sphere(2), sheet = random_sheet(1, 4, 3, 0.5f);
    for (const PatchMesh* mesh : {&ball, &sheet}) {
        for (const int segments : {1, 2, 3, 8, 13})
            check_closed(mesh->topology, demand(Tessellation::uniform(mesh->topology, segments)));
        for (const int most : {2, 5, 16, 40})
            for (const Kind kind : {Kind::discrete, Kind::continuous})
                for (const bool whole : {false, true})
                    check_closed(
                        mesh->topology,
                        demand(Tessellation::adaptive(
                            mesh->topology, random_levels(mesh->topology, 7, most, whole), kind)));
    }
}

TEST_CASE("an edge of 1 segment may lie beside one of 128") {
    const PatchMesh ball = sphere(1);
    for (uint64_t seed = 0; seed < 4; ++seed) {
        Pcg32 random(seed);
        std::vector<float> levels;
        for (uint32_t e = 0; e < ball.topology.edge_count(); ++e)
            levels.push_back(random.uniform() < 0.5f ? 1.0f : 128.0f);
        check_closed(ball.topology, demand(Tessellation::adaptive(ball.topology, levels)));
    }
}

TEST_CASE("whole levels that are all the same give what one level for all gives") {
    const PatchMesh sheet = random_sheet(3, 3, 3, 0.4f);
    const Tessellation uniform = demand(Tessellation::uniform(sheet.topology, 6));
    const Tessellation adaptive = demand(Tessellation::adaptive(
        sheet.topology, std::vector<float>(sheet.topology.edge_count(), 6.0f)));
    CHECK(uniform.triangles == adaptive.triangles);
    CHECK(uniform.vertex_count() == adaptive.vertex_count());
    CHECK(uniform.triangles.size() == 36 * [&] {
        size_t count = 0;
        for (uint32_t f = 0; f < sheet.topology.face_count(); ++f)
            count += sheet.topology.face_size(f) == 3 ? 1 : 2;
        return count;
    }());
}

TEST_CASE("levels outside of 1 to 128 are refused by name") {
    const PatchMesh ball = sphere(1);
    std::vector<float> levels(ball.topology.edge_count(), 2.0f);
    for (const float bad : {0.5f, 129.0f, std::nanf("")}) {
        levels[3] = bad;
        const auto made = Tessellation::adaptive(ball.topology, levels);
        REQUIRE(!made);
        CHECK(made.error().code == Errc::bad_argument);
    }
    CHECK(!Tessellation::uniform(ball.topology, 0));
    CHECK(!Tessellation::uniform(ball.topology, 257));
}

void check_snapping(uint32_t from, uint32_t to, uint32_t continuous) {
    uint32_t last = 0;
    for (uint32_t k = 0; k <= from; ++k) {
        const uint32_t at = shared::snapped(k, from, to, continuous);
        REQUIRE(at >= last);
        REQUIRE(at <= last + 1);
        if (2 * k != from) REQUIRE(shared::snapped(from - k, from, to, continuous) == to - at);
        last = at;
    }
    REQUIRE(last == to);
}

TEST_CASE("snapping hits every place of the coarser edge in order, from both ends alike") {
    for (uint32_t from = 1; from <= 128; ++from)
        for (uint32_t to = 1; to <= from; ++to) check_snapping(from, to, 0);
    for (uint32_t from = 1; from <= 256; from *= 2)
        for (uint32_t to = 1; to <= from; to *= 2) check_snapping(from, to, 1);
}

TEST_CASE("continuous levels snap in one step as in several") {
    for (uint32_t k = 0; k <= 128; ++k)
        for (uint32_t middle = 128; middle >= 1; middle /= 2)
            for (uint32_t to = middle; to >= 1; to /= 2)
                REQUIRE(shared::snapped(shared::snapped(k, 128, middle, 1), middle, to, 1) ==
                        shared::snapped(k, 128, to, 1));
}

TEST_CASE("inner vertices come from one of the next of half the segments, inside if one is there") {
    const auto near = [](uint32_t a, uint32_t b) { return a + 1 >= b && b + 1 >= a; };
    for (const uint32_t n : {2u, 4u, 8u, 16u})
        for (uint32_t j = 1; j < n; ++j)
            for (uint32_t i = 1; i < n; ++i) {
                const auto inside_quad = [&](uint32_t a, uint32_t b) {
                    return shared::inside_quad(a, b, n);
                };
                const auto inside_triangle = [&](uint32_t a, uint32_t b) {
                    return shared::inside_triangle(a, b, n);
                };
                const auto check = [&](uvec2 from, bool triangle, const auto& inside) {
                    bool one_inside = false;
                    for (uint32_t b = 0; b <= n; b += 2)
                        for (uint32_t a = 0; a <= n; a += 2)
                            one_inside |= inside(a, b) && near(a, i) && near(b, j) &&
                                          (!triangle || near(a + b, i + j));
                    CHECK(from.x % 2 == 0);
                    CHECK(from.y % 2 == 0);
                    CHECK(near(from.x, i));
                    CHECK(near(from.y, j));
                    if (triangle) CHECK(near(from.x + from.y, i + j));
                    CHECK(inside(from.x, from.y) == one_inside);
                };
                check(shared::coarser_quad_vertex(i, j, n), false, inside_quad);
                if (inside_triangle(i, j))
                    check(shared::coarser_triangle_vertex(i, j, n), true, inside_triangle);
            }
}

using shared::PatchLevels;
using shared::PatternPoint;

/// The places of a pattern's vertices.
std::vector<vec2> places(const Pattern& pattern, uint32_t corners, uint32_t segments,
                         const PatchLevels& levels, uint32_t reversed) {
    std::vector<vec2> result;
    for (const uint32_t steps : pattern.steps) {
        const uint32_t i = steps & 0xffffu, j = steps >> 16;
        const PatternPoint p =
            corners == 3 ? shared::triangle_pattern_point(i, j, segments, levels, reversed)
                         : shared::quad_pattern_point(i, j, segments, levels, reversed);
        result.push_back({p.x, p.y});
    }
    return result;
}

TEST_CASE("patterns with a level per edge cover their polygon without folds") {
    Pcg32 random(5);
    for (int round = 0; round < 2000; ++round) {
        const uint32_t corners = 3 + random.next() % 2;
        const uint32_t continuous = random.next() % 2;
        PatchLevels levels = {};
        levels.continuous = continuous;
        float finest = 1;
        const float most = random.next() % 2 == 0 ? 64.0f : 8.0f;
        for (float& level : levels.edge) level = 1 + random.uniform() * (most - 1);
        for (uint32_t e = 0; e < corners; ++e) finest = std::max(finest, levels.edge[e]);
        const uint32_t segments = shared::edge_segments(finest, continuous);
        levels.inner = continuous == 1 ? shared::level_weight(finest, segments) : 1.0f;
        const int n = static_cast<int>(segments);
        const Pattern pattern = corners == 3 ? triangle_pattern(n) : quad_pattern(n);
        const auto at = places(pattern, corners, segments, levels, random.next() % 16);
        // The three inner vertices of a triangle's pattern of 4 come from its edges, whose vertices
        // may be far from where they belong.
        const bool may_fold = corners == 3 && segments == 4 && continuous == 1;
        double sum = 0;
        for (const uvec3 t : pattern.triangles) {
            const vec2 ab = at[t.y] - at[t.x], ac = at[t.z] - at[t.x];
            const double area = 0.5 * (double(ab.x) * double(ac.y) - double(ab.y) * double(ac.x));
            if (!may_fold) REQUIRE(area > -1e-7);
            sum += area;
        }
        REQUIRE(sum == doctest::Approx(corners == 3 ? 0.5 : 1).epsilon(1e-5));
    }
}

using Places = std::set<std::pair<float, float>>;

Places place_set(uint32_t corners, uint32_t segments, const PatchLevels& levels) {
    const int n = static_cast<int>(segments);
    const Pattern pattern = corners == 3 ? triangle_pattern(n) : quad_pattern(n);
    Places set;
    for (const vec2 p : places(pattern, corners, segments, levels, 0)) set.insert({p.x, p.y});
    return set;
}

TEST_CASE("continuous places are continuous in the levels, also where the pattern changes") {
    for (const uint32_t corners : {3u, 4u}) {
        const PatchLevels coarse = {{8, 3.5f, 5, 1}, 1, 1}, fine = {{8, 3.5f, 5, 1}, 0, 1};
        CHECK(place_set(corners, 8, coarse) == place_set(corners, 16, fine));
        const Pattern pattern = corners == 3 ? triangle_pattern(16) : quad_pattern(16);
        const PatchLevels before = {{8, 5, 9.001f, 4.0f}, 0.124f, 1};
        const PatchLevels after = {{8.001f, 5, 8.999f, 4.002f}, 0.126f, 1};
        const auto a = places(pattern, corners, 16, before, 5);
        const auto b = places(pattern, corners, 16, after, 5);
        for (size_t v = 0; v < a.size(); ++v) CHECK(length(a[v] - b[v]) < 0.001f);
    }
}

TEST_CASE("both faces of an edge place the same vertices on it") {
    for (const uint32_t continuous : {0u, 1u})
        for (const float level : {1.0f, 3.0f, 7.25f, 16.0f, 20.5f}) {
            std::array<std::set<float>, 2> parameters;
            const PatchLevels levels = {{level, level, level, level}, 1, continuous};
            for (const uint32_t steps : triangle_pattern(32).steps) {
                const PatternPoint p =
                    shared::triangle_pattern_point(steps & 0xffffu, steps >> 16, 32, levels, 0);
                if (p.edge == 1) parameters[0].insert(p.t);
            }
            for (const uint32_t steps : quad_pattern(64).steps) {
                const PatternPoint p =
                    shared::quad_pattern_point(steps & 0xffffu, steps >> 16, 64, levels, 15);
                if (p.edge == 2) parameters[1].insert(p.t);
            }
            // Corners of a polygon belong to the edge before or after them.
            for (auto& set : parameters) set.insert({0.0f, 1.0f});
            CHECK(parameters[0] == parameters[1]);
            CHECK(parameters[0].size() == shared::edge_segments(level, continuous) + 1);
        }
}

}  // namespace
