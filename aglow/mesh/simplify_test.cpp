// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/simplify.h"

#include "aglow/mesh/control_mesh.h"
#include "aglow/mesh/testing/meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace aglow;
using mesh::testing::sheet;

namespace {

/// A wavy square of 2 n^2 triangles with texture coordinates.
Primitive waves(uint32_t n) {
    Primitive p = sheet(n, n, [](float x, float y) {
        return vec3{x, y, 0.05f * std::sin(9 * x) * std::cos(7 * y)};
    });
    std::vector<vec2> uvs;
    for (const vec3 at : p.positions) uvs.push_back({at.x, at.y});
    p.texcoords = {uvs};
    return p;
}

Mesh mesh_of(std::vector<Primitive> primitives) {
    Mesh mesh;
    mesh.primitives = std::move(primitives);
    return mesh;
}

/// Triangles that share no vertex, as flat shading has them.
Primitive shattered(const Primitive& p) {
    std::vector<uint32_t> sources;
    std::vector<uvec3> triangles;
    for (const uvec3 t : p.triangles) {
        const auto first = static_cast<uint32_t>(sources.size());
        sources.insert(sources.end(), {t.x, t.y, t.z});
        triangles.push_back({first, first + 1, first + 2});
    }
    Primitive result = copied_vertices(p, sources);
    result.triangles = triangles;
    for (size_t i = 0; i < result.normals.size(); ++i)
        result.normals[i] = normalize(vec3{float(i / 3 % 7), 1, 2});
    return result;
}

}  // namespace

TEST_CASE("a smooth surface keeps the share of triangles that is asked for, and its square") {
    const Mesh dense = mesh_of({waves(40)});
    const auto coarse = simplify(dense, {.ratio = 0.1f});
    REQUIRE(coarse);
    CHECK(coarse->dense_triangles == 3200);
    CHECK(coarse->triangles <= 320);
    CHECK(coarse->triangles > 280);
    CHECK(coarse->error > 0);
    CHECK(coarse->error < 0.02f);
    double area = 0;
    const Primitive& p = coarse->mesh.primitives[0];
    for (const uvec3 t : p.triangles) {
        const vec3 n =
            cross(p.positions[t.y] - p.positions[t.x], p.positions[t.z] - p.positions[t.x]);
        area += n.z / 2;  // what it covers seen from above
    }
    CHECK(area == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("vertices that are left are the input's, with their attributes") {
    const Mesh dense = mesh_of({waves(20)});
    std::map<std::pair<float, float>, vec3> there;
    for (const vec3 p : dense.primitives[0].positions) there[{p.x, p.y}] = p;
    const auto coarse = simplify(dense, {.ratio = 0.2f});
    REQUIRE(coarse);
    const Primitive& p = coarse->mesh.primitives[0];
    REQUIRE(p.texcoords.size() == 1);
    for (size_t v = 0; v < p.positions.size(); ++v) {
        const vec3 at = p.positions[v];
        REQUIRE(there.contains({at.x, at.y}));
        CHECK(there[{at.x, at.y}].z == at.z);
        CHECK(p.texcoords[0][v].x == at.x);
        CHECK(p.texcoords[0][v].y == at.y);
    }
}

TEST_CASE("triangles that share no vertices but their places are simplified as one surface") {
    const auto whole = simplify(mesh_of({waves(30)}), {.ratio = 0.1f});
    const auto apart = simplify(mesh_of({shattered(waves(30))}), {.ratio = 0.1f});
    REQUIRE(whole);
    REQUIRE(apart);
    CHECK(apart->triangles <= whole->triangles + 4);
}

TEST_CASE("primitives of a mesh still meet after each was simplified") {
    Primitive left = waves(30), right = waves(30);
    for (vec3& p : right.positions) p.x += 1;
    for (size_t v = 0; v < right.positions.size(); ++v)  // the same wave along the common edge
        if (right.positions[v].x == 1) right.positions[v].z = left.positions[v + 30].z;
    const auto coarse = simplify(mesh_of({left, right}), {.ratio = 0.1f});
    REQUIRE(coarse);
    CHECK(coarse->triangles < 1000);
    const auto control = make_control_mesh(coarse->mesh);
    REQUIRE(control);
    for (uint32_t h = 0; h < control->topology.half_edge_count(); ++h) {
        if (control->topology.twin[h] != kNone) continue;
        const vec3 a = control->positions[control->topology.vertex[h]];
        const vec3 b = control->positions[control->topology.end(h)];
        CHECK_FALSE((a.x == 1 && b.x == 1));
    }
    // Whatever is asked for, all 31 vertices between them stay, on both sides.
    const auto coarsest = simplify(mesh_of({left, right}), {.ratio = 1e-6f});
    REQUIRE(coarsest);
    for (const Primitive& p : coarsest->mesh.primitives)
        CHECK(std::ranges::count_if(p.positions, [](vec3 at) { return at.x == 1; }) == 31);
}

TEST_CASE("a ratio of 1 keeps every triangle") {
    const Mesh dense = mesh_of({waves(8)});
    const auto same = simplify(dense, {.ratio = 1});
    REQUIRE(same);
    CHECK(same->triangles == 128);
    CHECK(same->error == 0);
}

TEST_CASE("a bound on the error keeps more triangles") {
    const Mesh dense = mesh_of({waves(40)});
    const auto bounded = simplify(dense, {.ratio = 0.01f, .max_error = 1e-4f});
    const auto free = simplify(dense, {.ratio = 0.01f});
    REQUIRE(bounded);
    REQUIRE(free);
    CHECK(bounded->triangles > 4 * free->triangles);
    CHECK(bounded->error <= 1e-4f);
    for (int i = 1; i <= 40; ++i) {
        const float bound = 0.025f * static_cast<float>(i) * free->error;
        const auto tight = simplify(dense, {.ratio = 0.01f, .max_error = bound});
        REQUIRE(tight);
        CHECK(tight->error <= bound);
    }
}

TEST_CASE("closed surfaces keep at least the four triangles of the simplest one") {
    const Mesh ball = mesh_of({mesh::testing::sphere(12, 8)});
    const auto coarse = simplify(ball, {.ratio = 1e-6f});
    REQUIRE(coarse);
    CHECK(coarse->triangles >= 4);
    CHECK(coarse->triangles < 20);
    const auto control = make_control_mesh(coarse->mesh);
    REQUIRE(control);
    for (const uint32_t twin : control->topology.twin) CHECK(twin != kNone);
}

TEST_CASE("meshes of nothing, of points in one place and of one triangle stay what they are") {
    CHECK(simplify(Mesh(), {})->triangles == 0);
    CHECK(simplify(mesh_of({Primitive()}), {})->triangles == 0);
    const Primitive point =
        mesh::testing::primitive({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}});
    CHECK(simplify(mesh_of({point}), {})->triangles == 0);
    const Primitive one = mesh::testing::primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    CHECK(simplify(mesh_of({one}), {})->triangles == 1);
}

TEST_CASE("ratios that are no shares are bad arguments") {
    for (const float ratio : {0.0f, -1.0f, 1.5f, std::nanf("")}) {
        const auto result = simplify(Mesh(), {.ratio = ratio});
        REQUIRE_FALSE(result);
        CHECK(result.error().code == Errc::bad_argument);
    }
}
