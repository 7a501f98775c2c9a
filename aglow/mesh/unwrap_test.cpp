// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/unwrap.h"

#include "aglow/core/parallel.h"
#include "aglow/mesh/testing/layout_check.h"
#include "aglow/mesh/testing/meshes.h"

#include <doctest/doctest.h>

#include <cstring>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

UnwrapOptions at_resolution(int resolution) {
    UnwrapOptions options;
    options.resolution = resolution;
    return options;
}

Atlas unwrapped(Scene& scene, const UnwrapOptions& options) {
    Result<Atlas> atlas = unwrap(scene, options);
    REQUIRE_MESSAGE(atlas.has_value(), (atlas ? "" : to_string(atlas.error())));
    return *atlas;
}

void check_sound(const Scene& scene, const Atlas& atlas, int gutter) {
    const LayoutFaults faults = find_faults(pose(scene, -1, &atlas), atlas, gutter);
    CHECK(faults.out_of_range == 0);
    CHECK(faults.lost == 0);
    CHECK(faults.overlaps == 0);
    CHECK(faults.near == 0);
}

Primitive with_lightmap_set(Primitive p, std::vector<vec2> uvs) {
    p.texcoords = {std::vector<vec2>(p.positions.size(), vec2{0, 0}), std::move(uvs)};
    return p;
}

/// Square texel areas per square metre of every triangle large enough to tell.
std::vector<double> densities(const Surfaces& s) {
    std::vector<double> found;
    for (uint32_t t = 0; t < s.triangles.size(); ++t) {
        const uvec3 v = s.triangles[t];
        const vec2 a = s.lightmap_uvs[v.x], b = s.lightmap_uvs[v.y] - a,
                   c = s.lightmap_uvs[v.z] - a;
        const double texels = std::abs(double(b.x) * double(c.y) - double(b.y) * double(c.x)) / 2;
        if (texels > 50) found.push_back(texels / double(area(s, t)));
    }
    return found;
}

}  // namespace

TEST_CASE("a box has six charts and fills its atlas well") {
    Scene scene = scene_of({box({1, 1, 1})});
    const Atlas atlas = unwrapped(scene, at_resolution(256));
    CHECK(atlas.chart_count == 6);
    CHECK(atlas.origins[0] == UvOrigin::charts);
    check_sound(scene, atlas, 2);
    const Surfaces s = pose(scene, -1, &atlas);
    const size_t covered = rasterize(s, atlas, 1).element_count();
    CHECK(double(covered) > 0.85 * atlas.width * atlas.height);
    for (double d : densities(s)) CHECK(d == doctest::Approx(densities(s)[0]).epsilon(0.03));
}

TEST_CASE("a smooth sphere has few charts and bounded stretch") {
    Scene scene = scene_of({sphere(64, 32)});
    const Atlas atlas = unwrapped(scene, at_resolution(512));
    CHECK(atlas.chart_count <= 16);
    check_sound(scene, atlas, 2);
    const double mean = 1 / (double(atlas.texel_size) * double(atlas.texel_size));
    for (double d : densities(pose(scene, -1, &atlas))) {
        CHECK(d > 0.4 * mean);
        CHECK(d < 2.5 * 1.4 * mean);  // texels may be 1.4 times finer along v
    }
}

TEST_CASE("five equal walls fill an atlas of equal width and height") {
    // Axis-parallel squares of equal size cannot fill more than 5/9 of it: texels become oblong.
    std::vector<Primitive> walls;
    for (float z : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f}) {
        walls.push_back(unit_quad());
        for (vec3& p : walls.back().positions) p.z = z;
    }
    Scene scene = scene_of(walls);
    const Atlas atlas = unwrapped(scene, at_resolution(512));
    CHECK(atlas.width == 512);
    CHECK(atlas.height <= 512);
    CHECK(rasterize(pose(scene, -1, &atlas), atlas, 1).element_count() > 512 * 512 * 3 / 4);
    check_sound(scene, atlas, 2);
}

TEST_CASE("texels have the asked size on every instance, whatever its scale") {
    Scene scene =
        scene_of({box({1, 1, 1})}, {scaling({1, 1, 1}), scaling({3, 3, 3}), scaling({-2, 2, 2})});
    UnwrapOptions options;
    options.texel_size = 0.02f;
    const Atlas atlas = unwrapped(scene, options);
    CHECK(atlas.texel_size == doctest::Approx(0.02));
    REQUIRE(atlas.placements.size() == 3);
    check_sound(scene, atlas, 2);
    const double wanted = 1 / (0.02 * 0.02);
    for (double d : densities(pose(scene, -1, &atlas)))
        CHECK(d == doctest::Approx(wanted).epsilon(0.05));
}

TEST_CASE("a wall made of a stretched unit cube has square texels") {
    Scene scene = scene_of({box({1, 1, 1})}, {scaling({8, 3, 0.2f})});
    UnwrapOptions options;
    options.texel_size = 0.05f;
    const Atlas atlas = unwrapped(scene, options);
    const Surfaces s = pose(scene, -1, &atlas);
    for (uint32_t t = 0; t < s.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const uvec3 v = s.triangles[t];
            const std::array<uint32_t, 3> corners = {v.x, v.y, v.z};
            const uint32_t a = corners[size_t(i)], b = corners[size_t((i + 1) % 3)];
            const double meters = double(length(s.positions[a] - s.positions[b]));
            const double texels = double(length(s.lightmap_uvs[a] - s.lightmap_uvs[b]));
            CHECK(texels == doctest::Approx(meters / 0.05).epsilon(0.05));
        }
}

TEST_CASE("a valid second UV set is kept, and placed at uniform density") {
    // UVs are twice as long along v: the placement makes up for it.
    Primitive quad =
        with_lightmap_set(unit_quad(), {{0.1f, 0}, {0.5f, 0}, {0.5f, 0.8f}, {0.1f, 0.8f}});
    Scene scene = scene_of({quad});
    UnwrapOptions options;
    options.texel_size = 0.01f;
    const Atlas atlas = unwrapped(scene, options);
    CHECK(atlas.origins[0] == UvOrigin::file);
    CHECK(atlas.chart_count == 1);
    const Primitive& p = scene.meshes[0].primitives[0];
    CHECK(p.lightmap_uvs == p.texcoords[1]);
    CHECK(p.source_vertex.empty());
    check_sound(scene, atlas, 2);
    CHECK(atlas.placements[0].scale.x == doctest::Approx(100 / 0.4).epsilon(0.02));
    CHECK(atlas.placements[0].scale.y == doctest::Approx(100 / 0.8).epsilon(0.02));
}

TEST_CASE("a second UV set that overlaps, leaves the square or has no area is replaced") {
    const std::vector<std::vector<vec2>> bad = {
        {{0, 0}, {1, 0}, {1, 1}, {0.9f, 0.2f}},  // the second triangle lies over the first
        {{0, 0}, {1.5f, 0}, {1.5f, 1}, {0, 1}},  // out of range
        {{0, 0}, {1, 0}, {0, 0}, {0, 1}},        // both triangles without area
        {{0, 0}, {1, 0}, {NAN, 1}, {0, 1}}};
    for (const auto& uvs : bad) {
        Scene scene = scene_of({with_lightmap_set(unit_quad(), uvs)});
        const Atlas atlas = unwrapped(scene, at_resolution(64));
        CHECK(atlas.origins[0] == UvOrigin::charts);
        check_sound(scene, atlas, 2);
    }
    // Two primitives of one mesh that use the same place.
    const std::vector<vec2> whole = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Primitive above = with_lightmap_set(unit_quad(), whole);
    for (vec3& p : above.positions) p.z = 1;
    Scene scene = scene_of({with_lightmap_set(unit_quad(), whole), above});
    CHECK(unwrapped(scene, at_resolution(64)).origins[0] == UvOrigin::charts);
}

TEST_CASE("vertices split at chart borders keep all they had") {
    Primitive p = box({1, 1, 1});
    const size_t n = p.positions.size();
    p.influences = 4;
    p.source_vertex = {10, 11, 12, 13, 14, 15, 16, 17};
    p.targets.resize(1);
    for (uint32_t v = 0; v < n; ++v) {
        p.colors.push_back({float(v), 0, 0, 1});
        p.sharpness.push_back(float(v));
        p.tension.push_back(float(2 * v));
        p.bias.push_back(float(3 * v));
        for (uint32_t i = 0; i < 4; ++i) {
            p.joints.push_back(4 * v + i);
            p.weights.push_back(float(4 * v + i));
        }
        p.targets[0].positions.push_back({0, float(v), 0});
    }
    Scene scene = scene_of({p});
    unwrapped(scene, at_resolution(64));
    const Primitive& split = scene.meshes[0].primitives[0];
    const size_t m = split.positions.size();
    CHECK(m == 24);
    REQUIRE(split.lightmap_uvs.size() == m);
    REQUIRE(split.source_vertex.size() == m);
    REQUIRE(split.joints.size() == 4 * m);
    CHECK(split.targets[0].normals.empty());
    for (size_t v = 0; v < m; ++v) {
        const uint32_t from = split.source_vertex[v] - 10;
        REQUIRE(from < n);
        CHECK(split.positions[v] == p.positions[from]);
        CHECK(split.colors[v] == p.colors[from]);
        CHECK(split.sharpness[v] == p.sharpness[from]);
        CHECK(split.tension[v] == p.tension[from]);
        CHECK(split.bias[v] == p.bias[from]);
        CHECK(split.joints[4 * v + 3] == 4 * from + 3);
        CHECK(split.weights[4 * v + 2] == float(4 * from + 2));
        CHECK(split.targets[0].positions[v].y == float(from));
    }
    for (size_t t = 0; t < p.triangles.size(); ++t)
        CHECK(split.positions[split.triangles[t].y] == p.positions[p.triangles[t].y]);
}

TEST_CASE("meshes without triangles and scenes without meshes are no error") {
    Scene empty;
    CHECK(unwrapped(empty, at_resolution(64)).placements.empty());
    Scene points = scene_of({primitive({{0, 0, 0}, {1, 0, 0}}, {})}, {mat4{}, mat4{}});
    const Atlas atlas = unwrapped(points, at_resolution(64));
    CHECK(atlas.placements.size() == 2);
    CHECK(atlas.chart_count == 0);
    CHECK(rasterize(pose(points, -1, &atlas), atlas, 4).element_count() == 0);
}

TEST_CASE("a texel size that fits no atlas is refused, and the one named would do") {
    Scene scene = scene_of({box({10, 10, 10})});
    UnwrapOptions options;
    options.texel_size = 0.01f;
    options.max_resolution = 256;
    const Result<Atlas> refused = unwrap(scene, options);
    REQUIRE(!refused);
    CHECK(refused.error().code == Errc::bad_argument);
    const size_t semicolon = refused.error().message.find("; ");
    REQUIRE(semicolon != std::string::npos);
    options.texel_size = 1.05f * std::stof(refused.error().message.substr(semicolon + 2));
    CHECK(unwrap(scene, options).has_value());
}

TEST_CASE("options out of range are refused") {
    const auto code = [](UnwrapOptions options) {
        Scene scene = scene_of({unit_quad()});
        const Result<Atlas> atlas = unwrap(scene, options);
        return !atlas && atlas.error().code == Errc::bad_argument;
    };
    CHECK(code(at_resolution(0)));
    CHECK(code(at_resolution(100'000)));
    UnwrapOptions options;
    options.texel_size = -1;
    CHECK(code(options));
    options.texel_size = NAN;
    CHECK(code(options));
}

TEST_CASE("more charts than square rows can hold make a higher atlas") {
    Primitive crowd;
    for (uint32_t i = 0; i < 900; ++i) {
        const auto x = float(i % 30), z = float(i / 30);
        const auto first = static_cast<uint32_t>(crowd.positions.size());
        for (vec3 p : {vec3{x, 0, z}, vec3{x, 0, z + 0.5f}, vec3{x + 0.5f, 0, z}})
            crowd.positions.push_back(p);
        crowd.triangles.push_back({first, first + 1, first + 2});
    }
    crowd.normals.assign(crowd.positions.size(), vec3{0, 1, 0});
    Scene scene = scene_of({crowd});
    const Atlas atlas = unwrapped(scene, at_resolution(64));
    CHECK(atlas.width == 64);
    CHECK(atlas.height > 64);
    check_sound(scene, atlas, 2);
}

TEST_CASE("work stops when asked to") {
    Scene scene = scene_of({box({1, 1, 1})});
    const std::atomic<bool> stop = true;
    Monitor monitor;
    monitor.cancel = &stop;
    const Result<Atlas> atlas = unwrap(scene, at_resolution(64), monitor);
    REQUIRE(!atlas);
    CHECK(atlas.error().code == Errc::cancelled);
}

TEST_CASE("charts are the same bits for one thread and for two") {
    const auto run = [](int threads, Scene& scene) {
        const ThreadLimit limit(threads);
        return unwrapped(scene, at_resolution(256));
    };
    Scene one = scene_of({torus(60, 30, 2, 0.7f), sphere(20, 10)}, {mat4{}, scaling({2, 2, 2})});
    one.meshes.push_back({"second", {mobius_strip(40)}, {}});
    one.nodes.push_back(one.nodes[0]);
    one.nodes.back().mesh = 1;
    Scene two = one;
    const Atlas a = run(1, one), b = run(2, two);
    CHECK(a.height == b.height);
    for (size_t p = 0; p < a.placements.size(); ++p) {
        CHECK(a.placements[p].scale == b.placements[p].scale);
        CHECK(a.placements[p].offset == b.placements[p].offset);
    }
    for (size_t m = 0; m < 2; ++m)
        for (size_t i = 0; i < one.meshes[m].primitives.size(); ++i)
            CHECK(one.meshes[m].primitives[i].lightmap_uvs ==
                  two.meshes[m].primitives[i].lightmap_uvs);
}
