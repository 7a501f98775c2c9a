// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu_scene.h"

#include "aglow/accel/gpu/testing/closed_meshes.h"
#include "aglow/accel/gpu/testing/rays.h"
#include "aglow/core/testing/demand.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::testing;

namespace {

constexpr std::array kAccels = {Accel::grid, Accel::grid2, Accel::bvh};

Surfaces wavy_ring() { return ring({0, 0, 0}, 3, 1, 0.2f, 24); }

GpuScene make(const vk::TestDevice& device, const Surfaces& surfaces, Accel accel) {
    return demand(GpuScene::create(device.gpu(), surfaces, accel));
}

}  // namespace

TEST_CASE("a shadow ray is blocked where a ray of its length meets something") {
    vk::TestDevice device;
    if (!device) return;
    const Surfaces surfaces = wavy_ring();
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        GpuScene scene = make(device, surfaces, accel);
        auto rays = RaySource(surfaces, 3).rays(RayClass::surface, 5000);
        for (size_t i = 0; i < rays.size(); ++i)
            rays[i].far = 0.2f + 0.001f * static_cast<float>(i);
        const auto hits = demand(scene.intersect(rays));
        const auto blocked = demand(scene.occluded(rays));
        size_t wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            wrong += (hits[i].triangle != GpuScene::kNoHit) != (blocked[i] == 1);
        CHECK(wrong == 0);
    }
}

TEST_CASE("no ray leaves a closed mesh, be it aimed at its edges and vertices") {
    vk::TestDevice device;
    if (!device) return;
    for (const ClosedMesh& mesh : closed_meshes())
        for (const Accel accel : kAccels) {
            CAPTURE(mesh.name);
            CAPTURE(std::string(name(accel)));
            GpuScene scene = make(device, mesh.surfaces, accel);
            const auto rays = rays_from_inside(mesh, 20000, 7);
            const auto hits = demand(scene.intersect(rays));
            CHECK(std::count_if(hits.begin(), hits.end(), [](const GpuScene::GpuHit& hit) {
                      return hit.triangle == GpuScene::kNoHit;
                  }) == 0);
            const auto blocked = demand(scene.occluded(rays));
            CHECK(std::count(blocked.begin(), blocked.end(), 0u) == 0);
        }
}

TEST_CASE("batches of any size give each ray its own answer") {
    vk::TestDevice device;
    if (!device) return;
    const Surfaces surfaces = wavy_ring();
    GpuScene scene = make(device, surfaces, Accel::bvh);
    const auto rays = RaySource(surfaces, 5).rays(RayClass::uniform, 300000);
    const auto all = demand(scene.intersect(rays));
    REQUIRE(all.size() == rays.size());
    for (const size_t first : {size_t{0}, size_t{262143}, size_t{262144}, size_t{299990}})
        for (const size_t count : {0, 1, 10}) {
            const auto some = demand(scene.intersect(std::span(rays).subspan(first, count)));
            REQUIRE(some.size() == count);
            for (size_t i = 0; i < count; ++i) {
                CHECK(some[i].triangle == all[first + i].triangle);
                CHECK(some[i].distance == all[first + i].distance);
            }
        }
}

TEST_CASE("rays that count their work find the same") {
    vk::TestDevice device;
    if (!device) return;
    const Surfaces surfaces = wavy_ring();
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        GpuScene scene = make(device, surfaces, accel);
        const auto rays = RaySource(surfaces, 6).rays(RayClass::uniform, 3000);
        const auto plain = demand(scene.intersect(rays));
        CHECK(scene.stats().rays == 0);
        const auto counted = demand(scene.intersect(rays, Counting::on));
        for (size_t i = 0; i < rays.size(); ++i) {
            CHECK(plain[i].triangle == counted[i].triangle);
            CHECK(plain[i].distance == counted[i].distance);
        }
        const AccelStats once = scene.stats();
        CHECK(once.rays == rays.size());
        CHECK(once.steps > 0);
        CHECK(once.triangle_tests > 0);
        CHECK(once.triangle_tests < rays.size() * surfaces.triangles.size());
        CHECK(once.references >= surfaces.triangles.size());
        CHECK(once.bytes > surfaces.triangles.size() * 36);
        demand(scene.occluded(rays, Counting::on));
        const AccelStats twice = scene.stats();
        CHECK(twice.rays == 2 * rays.size());
        CHECK(twice.steps - once.steps <= once.steps);  // shadow rays stop at the first hit
    }
}

TEST_CASE("a scene with nothing in it is hit by nothing") {
    vk::TestDevice device;
    if (!device) return;
    for (const Accel accel : kAccels) {
        GpuScene scene = make(device, Surfaces{}, accel);
        const std::vector<Ray> rays(100, Ray{{0, 0, 0}, {0, 0, 1}});
        const auto hits = demand(scene.intersect(rays));
        for (const GpuScene::GpuHit& hit : hits) CHECK(hit.triangle == GpuScene::kNoHit);
        CHECK(demand(scene.occluded(rays)) == std::vector<uint32_t>(rays.size(), 0u));
    }
}

TEST_CASE("a rebuilt scene is that of the moved surfaces") {
    vk::TestDevice device;
    if (!device) return;
    Surfaces surfaces = wavy_ring();
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        GpuScene scene = make(device, surfaces, accel);
        const auto rays = RaySource(surfaces, 8).rays(RayClass::uniform, 2000);
        demand(scene.intersect(rays));
        Surfaces moved = surfaces;
        for (vec3& p : moved.positions) p = vec3{2 * p.z, p.x - 0.3f, p.y};
        demand(scene.rebuild(moved));
        GpuScene fresh = make(device, moved, accel);
        const auto hits = demand(scene.intersect(rays));
        const auto expected = demand(fresh.intersect(rays));
        for (size_t i = 0; i < rays.size(); ++i) {
            CHECK(hits[i].triangle == expected[i].triangle);
            CHECK(hits[i].distance == expected[i].distance);
        }
    }
}

namespace {

vk::DeviceOptions failing(vk::Faults faults) {
    vk::DeviceOptions options;
    options.faults = faults;
    return options;
}

/// Everything a user of the scene does; what failed first.
Status use(const Gpu& gpu, const Surfaces& surfaces, Accel accel, std::span<const Ray> rays) {
    AG_TRY(GpuScene scene, GpuScene::create(gpu, surfaces, accel));
    AG_TRY(const auto hits, scene.intersect(rays));
    AG_TRY(const auto blocked, scene.occluded(rays));
    return scene.rebuild(surfaces);
}

}  // namespace

TEST_CASE("any allocation may fail: the error says so, nothing leaks, the device works on") {
    const Surfaces surfaces = wavy_ring();
    const auto rays = RaySource(surfaces, 9).rays(RayClass::uniform, 200);
    for (const Accel accel : {Accel::grid2, Accel::bvh}) {  // a grid is half of a grid2
        CAPTURE(std::string(name(accel)));
        for (int n = 0;; ++n) {
            CAPTURE(n);
            vk::TestDevice device(failing({.fail_allocation = n, .lose_at_submit = -1}));
            if (!device) return;
            const Status first = use(device.gpu(), surfaces, accel, rays);
            if (first) {
                CHECK(n > 5);
                break;
            }
            CHECK(first.error().code == Errc::out_of_memory);
            CHECK(first.error().message.find("bytes") != std::string::npos);
            if (n % 8 == 7) CHECK(use(device.gpu(), surfaces, accel, rays));
        }
    }
}

TEST_CASE("a scene whose allocation failed once works when it is tried again") {
    const Surfaces surfaces = wavy_ring();
    const auto rays = RaySource(surfaces, 9).rays(RayClass::uniform, 200);
    int allocations = 0;
    {
        vk::TestDevice device;
        if (!device) return;
        GpuScene scene = make(device, surfaces, Accel::bvh);
        allocations = device->allocation_count();
    }
    vk::TestDevice device(failing({.fail_allocation = allocations, .lose_at_submit = -1}));
    GpuScene scene = make(device, surfaces, Accel::bvh);
    const auto failed = scene.intersect(rays);
    REQUIRE(!failed);
    CHECK(failed.error().code == Errc::out_of_memory);
    demand(scene.intersect(rays));
    GpuScene fresh = make(device, surfaces, Accel::bvh);
    CHECK(demand(scene.occluded(rays)) == demand(fresh.occluded(rays)));
}

TEST_CASE("a device may be lost at any submit: the error says so and nothing leaks") {
    const Surfaces surfaces = wavy_ring();
    const auto rays = RaySource(surfaces, 10).rays(RayClass::uniform, 200);
    for (const Accel accel : {Accel::grid2, Accel::bvh}) {  // a grid is half of a grid2
        CAPTURE(std::string(name(accel)));
        for (int n = 0;; ++n) {
            CAPTURE(n);
            vk::TestDevice device(failing({.fail_allocation = -1, .lose_at_submit = n}));
            if (!device) return;
            const Status status = use(device.gpu(), surfaces, accel, rays);
            if (status) {
                CHECK(n > 2);
                break;
            }
            CHECK(status.error().code == Errc::device_lost);
        }
    }
}

TEST_CASE("a structure is chosen by how many rays pay for its build") {
    for (const uint64_t triangles : {1000ull, 100000ull, 10000000ull}) {
        CAPTURE(triangles);
        CHECK(choose_accel({.triangles = triangles, .rays_per_build = 0}) == Accel::grid);
        CHECK(choose_accel({.triangles = triangles}) == Accel::bvh);
        // More rays never make a slower build the worse choice.
        Accel last = Accel::grid;
        for (double rays = 1; rays < 1e12; rays *= 1.5) {
            const Accel chosen = choose_accel({triangles, rays});
            CHECK(chosen >= last);
            last = chosen;
        }
        CHECK(last == Accel::bvh);
    }
    CHECK(choose_accel({.triangles = 1000000, .rays_per_build = 1.4e5}) == Accel::grid);
    CHECK(choose_accel({.triangles = 1000000, .rays_per_build = 1.7e5}) == Accel::bvh);
    CHECK(choose_accel({.triangles = 0, .rays_per_build = 0}) == Accel::grid);
    CHECK(std::string(name(Accel::grid2)) == "grid2");
}
