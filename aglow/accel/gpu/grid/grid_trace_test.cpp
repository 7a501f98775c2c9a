// SPDX-License-Identifier: Apache-2.0
// What rays hit in grids, against all triangles tried one by one.
#include "aglow/accel/gpu/testing/grid_harness.h"
#include "aglow/accel/gpu/testing/grid_scenes.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace aglow;
using namespace aglow::accel::gpu;
using shared::kNoTriangle;

namespace {

constexpr uint32_t kKinds[] = {shared::kStructureGrid, shared::kStructureGrid2};

vec3 point_on(const Triangle& t, Pcg32& random) {
    const float u = random.uniform(), v = random.uniform() * (1 - u);
    return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
}

/// Rays of all kinds about a scene: at random, through corners, along and through edges, parallel
/// to axes and planes, starting on surfaces, inside and outside of the scene, limited.
std::vector<RayQuery> rays_about(const Triangles& triangles, uint32_t count, uint64_t seed) {
    Box box;
    for (const Triangle& t : triangles) {
        if (!shared::is_usable_triangle(t)) continue;
        for (vec3 p : {t.a, t.b, t.c}) box.add(p);
    }
    if (box.empty()) box = {{0, 0, 0}, {1, 1, 1}};
    const vec3 grown = box.size() * 0.3f + vec3{0.01f, 0.01f, 0.01f};
    const vec3 low = box.lo - grown, high = box.hi + grown;
    Pcg32 random(seed);
    std::vector<RayQuery> rays;
    while (rays.size() < count) {
        const Triangle& t = triangles[random.next() % triangles.size()];
        if (!shared::is_usable_triangle(t)) {
            rays.push_back(random_ray(random, low, high));
            continue;
        }
        RayQuery ray = random_ray(random, low, high);
        const uint32_t kind = static_cast<uint32_t>(rays.size() % 8);
        if (kind == 1) ray.direction = t.a - ray.origin;
        if (kind == 2) ray.direction = shared::mix(t.a, t.b, random.uniform()) - ray.origin;
        if (kind == 3) ray = {t.a - (t.b - t.a), 0, t.b - t.a, kInfinity};
        if (kind == 4) ray.origin = point_on(t, random);
        if (kind == 5) ray.far = 0.5f;
        if (kind >= 6) {  // one or two components are zero; some start in the plane of a corner
            const float sign = random.uniform() < 0.5f ? -1.0f : 1.0f;
            const uint32_t axis = random.next() % 3;
            if (kind == 7) ray.origin = random.uniform() < 0.5f ? t.a : low + (t.a - low) * 0.5f;
            if (axis == 0) ray.direction = {sign, 0, 0};
            if (axis == 1) ray.direction = {0, sign, 0};
            if (axis == 2) ray.direction = {random.uniform(), 0, sign};
        }
        if (shared::dot(ray.direction, ray.direction) > 0) rays.push_back(ray);
    }
    return rays;
}

/// Rays whose answer is not the reference's. An answer that differs only as the same triangles in
/// another order of arithmetic may differ is right.
uint32_t wrong_answers(GridHarness& grid, const Triangles& triangles,
                       const std::vector<RayQuery>& rays) {
    const Traced nearest = grid.trace(rays);
    const Traced any = grid.trace(rays, true);
    uint32_t wrong = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const RayHit expected = nearest_hit(triangles, rays[i]);
        const RayHit& found = nearest.hits[i];
        const bool miss = expected.triangle == kNoTriangle;
        bool right = (found.triangle == kNoTriangle) == miss &&
                     (any.hits[i].triangle == kNoTriangle) == miss;
        if (right && !miss) right = std::abs(found.t - expected.t) <= 1e-5f * expected.t;
        if (right && found.triangle == expected.triangle && !miss) {
            right = std::abs(found.barycentrics.x - expected.barycentrics.x) < 1e-3f &&
                    std::abs(found.barycentrics.y - expected.barycentrics.y) < 1e-3f;
        }
        if (!right) {
            ++wrong;
            MESSAGE("ray " << i << ": triangle " << found.triangle << " at " << found.t
                           << ", expected " << expected.triangle << " at " << expected.t);
        }
    }
    return wrong;
}

/// Rays from inside a closed surface that leave it.
uint64_t leaks(GridHarness& grid, vec3 center, float radius, uint32_t count) {
    Pcg32 random(9);
    std::vector<RayQuery> rays;
    const vec3 r = {radius, radius, radius};
    for (uint32_t i = 0; i < count; ++i) {
        RayQuery ray = random_ray(random, center - r, center + r);
        if (i % 5 == 0) ray.direction.x = 0;
        if (i % 7 == 0) ray.direction.y = 0;
        if (shared::dot(ray.direction, ray.direction) == 0) ray.direction.z = 1;
        rays.push_back(ray);
    }
    uint64_t missed = 0;
    for (const RayHit& hit : grid.trace(rays).hits) missed += hit.triangle == kNoTriangle;
    return missed;
}

}  // namespace

TEST_CASE("rays hit in grids what they hit among all triangles") {
    vk::TestDevice device;
    if (!device) return;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Triangle ground = {{-300, -0.1f, -300}, {300, -0.1f, -300}, {0, -0.2f, 300}};
    Triangles broken = soup(300, 0.1f, 11);
    for (size_t i = 0; i < broken.size(); i += 3) broken[i].b.y = i % 2 == 0 ? nan : kInfinity;
    for (size_t i = 1; i < broken.size(); i += 7) broken[i].c = broken[i].a;
    Triangles flat = soup(500, 0.1f, 12);
    for (Triangle& t : flat) t.a.y = t.b.y = t.c.y = 0.25f;
    const struct {
        const char* name;
        Triangles triangles;
    } scenes[] = {{"small triangles", soup(2000, 0.04f, 1)},
                  {"long triangles", soup(300, 0.8f, 2)},
                  {"sphere", sphere({1, 2, 3}, 4, 48, 24)},
                  {"cube", cube(-1, 1)},
                  {"one triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}},
                  {"flat", flat},
                  {"all the same", Triangles(400, {{0, 0, 0}, {1, 0.2f, 0}, {0, 1, 0.1f}})},
                  {"huge and tiny", joined(soup(1500, 0.002f, 3), {ground})},
                  {"broken", broken},
                  {"far from the origin", moved(soup(500, 2.0f, 4), {1e6f, -1e6f, 1e6f})},
                  {"forest", forest(6, 250, 5)},
                  {"nothing usable", {{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}}}};
    for (uint32_t kind : kKinds) {
        GridHarness grid(device.gpu(), kind);
        for (const auto& scene : scenes) {
            CAPTURE(kind);
            CAPTURE(std::string(scene.name));
            REQUIRE(grid.build(scene.triangles));
            CHECK(wrong_answers(grid, scene.triangles, rays_about(scene.triangles, 2000, 6)) == 0);
        }
        REQUIRE(grid.build(Triangles{}));
        CHECK(grid.trace(rays_about(flat, 100, 7)).hits[0].triangle == kNoTriangle);
    }
}

TEST_CASE("closed surfaces let no ray out") {
    vk::TestDevice device;
    if (!device) return;
    for (uint32_t kind : kKinds) {
        CAPTURE(kind);
        GridHarness grid(device.gpu(), kind);
        REQUIRE(grid.build(sphere({0, 0, 0}, 1, 96, 48)));
        CHECK(leaks(grid, {0, 0, 0}, 0.55f, 100000) == 0);
        REQUIRE(grid.build(cube(-1, 1)));
        CHECK(leaks(grid, {0, 0, 0}, 0.99f, 50000) == 0);
        // Where coordinates are known to 1/16 m only.
        REQUIRE(grid.build(sphere({1e6f, 1e6f, 0}, 20, 48, 24)));
        CHECK(leaks(grid, {1e6f, 1e6f, 0}, 9, 50000) == 0);
    }
}

TEST_CASE("rays from far away hit a closed surface, where it is") {
    vk::TestDevice device;
    if (!device) return;
    Pcg32 random(8);
    std::vector<RayQuery> rays;
    for (int i = 0; i < 50000; ++i) {
        const vec3 target = random_vector(random, -0.5f, 0.5f);
        const vec3 away = random_vector(random, -1, 1);
        const vec3 origin = away * (1e4f / shared::length(away));
        rays.push_back({origin, 0, (target - origin) * 0.5f, kInfinity});
    }
    for (uint32_t kind : kKinds) {
        GridHarness grid(device.gpu(), kind);
        REQUIRE(grid.build(sphere({0, 0, 0}, 1, 64, 32)));
        const Traced traced = grid.trace(rays);
        uint32_t wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const RayHit& hit = traced.hits[i];
            const vec3 at = rays[i].origin + rays[i].direction * hit.t;
            // Rounding at 10 km is 1 mm; facets are up to 5 mm inside the sphere.
            wrong += hit.triangle == kNoTriangle || std::abs(shared::length(at) - 1) > 8e-3f ||
                     shared::dot(at, rays[i].direction) > 0;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("a two-level grid tests at most half as many triangles in a forest") {
    vk::TestDevice device;
    if (!device) return;
    const Triangles triangles = forest(300, 579, 1);
    Pcg32 random(2);
    std::vector<RayQuery> rays;
    for (int i = 0; i < 3000; ++i) rays.push_back(random_ray(random, {-50, 0, -50}, {50, 3, 50}));
    double tests[2];
    std::vector<RayHit> hits[2];
    for (uint32_t kind : kKinds) {
        GridHarness grid(device.gpu(), kind);
        REQUIRE(grid.build(triangles));
        Traced traced = grid.trace(rays);
        tests[kind] = traced.tests;
        hits[kind] = std::move(traced.hits);
    }
    CHECK(tests[1] < 0.5 * tests[0]);
    uint32_t different = 0;
    for (size_t i = 0; i < rays.size(); ++i) different += hits[0][i].t != hits[1][i].t;
    CHECK(different == 0);
}
