// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/trace_scene.h"

#include "aglow/accel/gpu/testing/agreement.h"
#include "aglow/accel/gpu/trace_rays.h"
#include "aglow/core/random.h"
#include "aglow/core/testing/demand.h"
#include "aglow/shared/triangle.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <bit>
#include <numeric>

using namespace aglow;
using namespace aglow::accel::gpu;
using shared::RayHit;
using shared::RayQuery;
using shared::Triangle;
using testing::Judge;
using testing::Verdict;

namespace {

constexpr std::array kAccels = {Accel::grid, Accel::grid2, Accel::bvh};
constexpr double kManyRays = 1e9;

/// The box around (-1, -1, -1) and (1, 1, 1).
std::vector<Triangle> box() {
    std::vector<Triangle> triangles;
    for (int face = 0; face < 6; ++face) {
        const auto corner = [&](float a, float b) {
            const float s = face % 2 == 0 ? 1.0f : -1.0f;
            return face / 2 == 0 ? vec3{s, a, b} : face / 2 == 1 ? vec3{a, s, b} : vec3{a, b, s};
        };
        triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
        triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
    return triangles;
}

/// Bodies that move by transforms, one group for each; triangles in world space.
struct World {
    std::vector<Group> groups;
    std::vector<Triangle> bodies;  // before they are moved
    std::vector<mat4> transforms;  // [groups]

    void add(const std::vector<Triangle>& body, Motion motion, const mat4& transform) {
        groups.push_back(
            {static_cast<uint32_t>(bodies.size()), static_cast<uint32_t>(body.size()), motion});
        bodies.insert(bodies.end(), body.begin(), body.end());
        transforms.push_back(transform);
    }
    std::vector<Triangle> triangles() const {
        std::vector<Triangle> moved = bodies;
        for (size_t g = 0; g < groups.size(); ++g)
            for (uint32_t i = 0; i < groups[g].triangle_count; ++i) {
                Triangle& t = moved[groups[g].first_triangle + i];
                const mat4& m = transforms[g];
                t = {transform_point(m, t.a), transform_point(m, t.b), transform_point(m, t.c)};
            }
        return moved;
    }
};

class Source {
public:
    explicit Source(uint64_t seed) : random_(seed) {}
    float centered() { return 2 * random_.uniform() - 1; }
    vec3 point(float size) { return vec3{centered(), centered(), centered()} * size; }
    uint32_t next() { return random_.next(); }
    mat4 transform(float spread) {
        vec4 turn{centered(), centered(), centered(), centered()};
        const float norm = std::sqrt(dot(turn, turn));
        const float scale = 0.5f + random_.uniform();
        const float mirror = random_.next() % 3 == 0 ? -1.0f : 1.0f;
        return compose(point(spread), turn * (1 / norm),
                       {scale * mirror, scale * (0.7f + 0.6f * random_.uniform()), scale});
    }
    /// From around the world to a place in it; directions of many lengths.
    std::vector<RayQuery> rays(size_t count, float size) {
        std::vector<RayQuery> rays;
        for (size_t i = 0; i < count; ++i) {
            const vec3 from = point(1.5f * size);
            vec3 direction = (point(size) - from) * std::ldexp(1.0f, static_cast<int>(i % 9) - 4);
            if (i % 7 == 0) direction.x = 0;
            if (i % 5 == 0) direction.z = 0;
            if (dot(direction, direction) == 0) direction.y = 1;
            rays.push_back({from, 0, direction, kInfinity});
        }
        return rays;
    }

private:
    Pcg32 random_;
};

/// A device with triangles on it, and rays through what is made of them.
class Rig {
public:
    explicit Rig(const vk::TestDevice& device)
        : gpu_(device.gpu()), stream_(device.stream()), kernels_(gpu_) {}

    TraceScene make(const World& world, Accel accel, double rays_per_update = kManyRays) {
        return demand(TraceScene::create(gpu_, world.groups, accel, rays_per_update));
    }

    void update(TraceScene& scene, const std::vector<Triangle>& triangles,
                std::span<const mat4> transforms) {
        buffer_ = demand(gpu_->make_buffer(triangles.size() * sizeof(Triangle), "world"));
        if (!triangles.empty()) stream_.upload(std::span<const Triangle>(triangles), buffer_);
        stream_.barrier();
        demand(scene.update(stream_, {buffer_.address(), static_cast<uint32_t>(triangles.size())},
                            transforms));
        demand(stream_.finish());
    }

    std::vector<RayHit> trace(const TraceScene& scene, std::span<const RayQuery> rays) {
        demand(kernels_.prepare(scene.kinds(), Query::nearest, Counting::off));
        demand(kernels_.prepare(scene.kinds(), Query::any, Counting::off));
        const vk::Buffer queries = demand(vk::make_buffer_of(stream_, rays, "rays"));
        const vk::Buffer hits = demand(gpu_->make_buffer(rays.size() * sizeof(RayHit), "hits"));
        const vk::Buffer blocked =
            demand(gpu_->make_buffer(rays.size() * sizeof(uint32_t), "blocked"));
        stream_.barrier();
        for (const Query query : {Query::nearest, Query::any})
            kernels_.record(stream_, scene.kinds(), query, Counting::off,
                            {.first_group = 0,
                             .ray_count = static_cast<uint32_t>(rays.size()),
                             .scene = scene.address(),
                             .rays = queries.address(),
                             .hits = hits.address(),
                             .blocked = blocked.address(),
                             .counts = 0});
        auto found = demand(stream_.download<RayHit>(hits, rays.size()));
        const auto any = demand(stream_.download<uint32_t>(blocked, rays.size()));
        size_t contradictions = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            contradictions += (any[i] == 1) != (found[i].triangle != shared::kNoTriangle);
        CHECK(contradictions == 0);
        return found;
    }

private:
    Gpu gpu_;
    vk::Stream stream_;
    TraceRays kernels_;
    vk::Buffer buffer_;
};

/// The nearest hit by testing every triangle.
RayHit nearest(const std::vector<Triangle>& triangles, const RayQuery& ray) {
    RayHit hit{ray.far, shared::kNoTriangle, {0, 0}};
    const shared::ShearedRay sheared = shared::sheared_ray(ray.origin, ray.direction);
    for (size_t i = 0; i < triangles.size(); ++i) {
        const auto found = shared::intersect_triangle(sheared, triangles[i], ray.near, hit.t);
        if (found.hit != 0) hit = {found.t, static_cast<uint32_t>(i), found.barycentrics};
    }
    return hit;
}

Judge::Answer answer(const RayHit& hit, float direction_length) {
    if (hit.triangle == shared::kNoTriangle) return {};
    return {hit.t * direction_length, hit.triangle};
}

/// Rays find in the scene what they find among all its triangles.
void check_hits(const std::vector<Triangle>& triangles, std::span<const RayQuery> rays,
                const std::vector<RayHit>& hits) {
    Surfaces surfaces;
    for (const Triangle& t : triangles) {
        const auto first = static_cast<uint32_t>(surfaces.positions.size());
        surfaces.positions.insert(surfaces.positions.end(), {t.a, t.b, t.c});
        surfaces.triangles.push_back({first, first + 1, first + 2});
    }
    const Judge judge(surfaces);
    size_t wrong = 0, rounded = 0, met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const float norm = length(rays[i].direction);
        const RayHit expected = nearest(triangles, rays[i]);
        met += expected.triangle != shared::kNoTriangle;
        const Verdict verdict = judge({rays[i].origin, rays[i].direction / norm},
                                      answer(hits[i], norm), answer(expected, norm));
        wrong += verdict == Verdict::differs;
        rounded += verdict == Verdict::rounded;
        // Shared edges apart, it is the same triangle and the same place on it.
        if (hits[i].triangle == expected.triangle && expected.triangle != shared::kNoTriangle)
            CHECK(length(hits[i].barycentrics - expected.barycentrics) < 1e-3f);
    }
    CHECK(wrong == 0);
    CHECK(rounded <= rays.size() / 1000);
    if (!triangles.empty()) CHECK(met > rays.size() / 50);
}

void check_rays(Rig& rig, const TraceScene& scene, const World& world,
                std::span<const RayQuery> rays) {
    check_hits(world.triangles(), rays, rig.trace(scene, rays));
}

World scattered(size_t count, Motion motion, uint64_t seed, float spread = 8) {
    Source source(seed);
    World world;
    for (size_t i = 0; i < count; ++i) world.add(box(), motion, source.transform(spread));
    return world;
}

}  // namespace

TEST_CASE("rigid bodies are built once; rays meet them wherever they go") {
    vk::TestDevice device;
    if (!device) return;
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        Rig rig(device);
        Source source(4);
        World world = scattered(20, Motion::rigid, 1);
        world.add(box(), Motion::still, compose({0, -9, 0}, {0, 0, 0, 1}, {9, 0.2f, 9}));
        TraceScene scene = rig.make(world, accel);
        for (int frame = 0; frame < 3; ++frame) {
            if (frame > 0)
                for (size_t g = 0; g < 20; ++g)
                    world.transforms[g] = source.transform(8.0f * static_cast<float>(frame));
            rig.update(scene, world.triangles(), world.transforms);
            CHECK(scene.work().built == (frame == 0 ? 21 : 0));
            check_rays(rig, scene, world, source.rays(2000, 9));
        }
    }
}

TEST_CASE("a body that vanishes into a point or grows a lot is rebuilt, and found again") {
    vk::TestDevice device;
    if (!device) return;
    Rig rig(device);
    Source source(5);
    World world = scattered(6, Motion::rigid, 2, 4);
    TraceScene scene = rig.make(world, Accel::bvh);
    const auto scaled = [](float s) { return compose({1, 0, 0}, {0, 0, 0, 1}, {s, s, s}); };
    for (const auto& step :
         {std::pair{1.0f, 6u}, {0.0f, 1u}, {1.0f, 1u}, {3.0f, 0u}, {50.0f, 1u}, {0.01f, 0u}}) {
        const float scale = step.first;
        const uint32_t built = step.second;
        CAPTURE(scale);
        world.transforms[2] = scaled(scale);
        rig.update(scene, world.triangles(), world.transforms);
        CHECK(scene.work().built == built);
        check_rays(rig, scene, world, source.rays(1000, 5));
    }
}

TEST_CASE("empty groups, broken triangles and no groups at all are hit by nothing") {
    vk::TestDevice device;
    if (!device) return;
    const float nan = std::nanf("");
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        Rig rig(device);
        Source source(6);
        World world;
        world.add({}, Motion::rigid, {});
        world.add(box(), Motion::rigid, source.transform(2));
        world.add({}, Motion::free, {});
        world.add({{{nan, 0, 0}, {1, nan, 0}, {0, 1, 1}}}, Motion::deforming, {});
        world.add(box(), Motion::still, source.transform(2));
        world.add({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, Motion::still, {});
        TraceScene scene = rig.make(world, accel);
        for (int frame = 0; frame < 2; ++frame) {
            rig.update(scene, world.triangles(), world.transforms);
            check_rays(rig, scene, world, source.rays(1000, 3));
        }
        World nothing;
        TraceScene empty = rig.make(nothing, accel);
        rig.update(empty, {}, {});
        check_hits({}, source.rays(100, 3), rig.trace(empty, source.rays(100, 3)));
    }
}

TEST_CASE("the order of groups does not matter") {
    vk::TestDevice device;
    if (!device) return;
    Rig rig(device);
    Source source(7);
    World world = scattered(12, Motion::rigid, 3, 5);
    const auto rays = source.rays(2000, 6);
    TraceScene scene = rig.make(world, Accel::bvh);
    rig.update(scene, world.triangles(), world.transforms);
    const auto hits = rig.trace(scene, rays);

    const auto triangles = world.triangles();
    for (size_t i = world.groups.size(); i-- > 1;) {
        const size_t j = source.next() % (i + 1);
        std::swap(world.groups[i], world.groups[j]);
        std::swap(world.transforms[i], world.transforms[j]);
    }
    TraceScene shuffled = rig.make(world, Accel::bvh);
    rig.update(shuffled, triangles, world.transforms);
    check_hits(triangles, rays, rig.trace(shuffled, rays));
    check_hits(triangles, rays, hits);
}

TEST_CASE("structures of several kinds stand side by side") {
    vk::TestDevice device;
    if (!device) return;
    Rig rig(device);
    Source source(8);
    World world = scattered(3, Motion::rigid, 4, 4);
    std::vector<Triangle> heap;  // for which a tree pays
    for (int i = 0; i < 40; ++i) {
        const vec3 at = source.point(4);
        for (const Triangle& t : box())
            heap.push_back({t.a * 0.3f + at, t.b * 0.3f + at, t.c * 0.3f + at});
    }
    world.add(heap, Motion::still, {});
    world.add(box(), Motion::free, source.transform(4));
    world.add(box(), Motion::rigid, source.transform(4));
    TraceScene scene = rig.make(world, Accel::automatic, 1);
    CHECK(std::popcount(scene.kinds()) == 2);
    for (int frame = 0; frame < 3; ++frame) {
        world.transforms[4] = source.transform(4);
        world.transforms[5] = source.transform(4);
        rig.update(scene, world.triangles(), world.transforms);
        CHECK(scene.work().built == (frame == 0 ? 6 : 1));
        check_rays(rig, scene, world, source.rays(1500, 5));
    }
}

TEST_CASE("a body that deforms a little is refitted; torn apart, it is rebuilt one update later") {
    vk::TestDevice device;
    if (!device) return;
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        const bool refits = accel == Accel::bvh;
        Rig rig(device);
        Source source(9);
        World world;
        std::vector<Triangle> body;
        for (int i = 0; i < 600; ++i) {
            const vec3 at = source.point(5);
            body.push_back({at, at + source.point(0.5f), at + source.point(0.5f)});
        }
        world.add(body, Motion::deforming, {});
        world.add(box(), Motion::still, {});
        TraceScene scene = rig.make(world, accel);
        const auto step = [&](uint32_t built, uint32_t refitted) {
            rig.update(scene, world.triangles(), world.transforms);
            CHECK(scene.work().built == built);
            CHECK(scene.work().refitted == refitted);
            check_rays(rig, scene, world, source.rays(1000, 6));
        };
        step(2, 0);
        for (size_t i = 0; i < 600; ++i) world.bodies[i].a += source.point(0.02f);
        step(refits ? 0 : 1, refits ? 1 : 0);
        step(refits ? 0 : 1, refits ? 1 : 0);
        std::vector<Triangle> scrambled(world.bodies.begin(), world.bodies.begin() + 600);
        for (size_t i = 0; i < 600; ++i) world.bodies[i] = scrambled[i * 7 % 600];
        step(refits ? 0 : 1, refits ? 1 : 0);
        step(1, 0);
        step(refits ? 0 : 1, refits ? 1 : 0);
    }
}

TEST_CASE("triangles that fly apart and come together again are found all the way") {
    vk::TestDevice device;
    if (!device) return;
    for (const Accel accel : kAccels) {
        CAPTURE(std::string(name(accel)));
        Rig rig(device);
        Source source(10);
        World world;
        std::vector<Triangle> body;
        std::vector<vec3> velocity;
        for (int i = 0; i < 200; ++i) {
            const vec3 at = source.point(1);
            body.push_back({at, at + source.point(0.5f), at + source.point(0.5f)});
            velocity.push_back(source.point(1) * std::ldexp(1.0f, i % 8));
        }
        world.add(body, Motion::free, {});
        TraceScene scene = rig.make(world, accel);
        for (const float time : {0.0f, 1.0f, 40.0f, 1.0f, 0.0f}) {
            CAPTURE(time);
            for (size_t i = 0; i < body.size(); ++i) {
                const vec3 shift = velocity[i] * time;
                world.bodies[i] = {body[i].a + shift, body[i].b + shift, body[i].c + shift};
            }
            rig.update(scene, world.triangles(), world.transforms);
            CHECK(scene.work().built == 1);
            auto rays = source.rays(1000, 1.5f);
            for (size_t i = 0; i < rays.size(); ++i)
                rays[i].direction = world.bodies[i % body.size()].a * 0.4f +
                                    world.bodies[i % body.size()].b * 0.6f - rays[i].origin;
            check_rays(rig, scene, world, rays);
        }
    }
}

TEST_CASE("an update that failed builds all anew") {
    World world = scattered(3, Motion::rigid, 5, 3);
    const auto triangles = world.triangles();
    /// Counts allocations before and in the first update; the n-th fails.
    const auto run = [&](int n) -> std::pair<int, int> {
        vk::DeviceOptions options;
        options.faults.fail_allocation = n;
        vk::TestDevice device(options);
        if (!device) return {0, 0};
        vk::Stream stream = device.stream();
        const vk::Buffer buffer =
            demand(vk::make_buffer_of(stream, std::span<const Triangle>(triangles), "world"));
        demand(stream.finish());
        auto scene = demand(TraceScene::create(device.gpu(), world.groups, Accel::bvh, kManyRays));
        const int before = device->allocation_count();
        const Status done = scene.update(
            stream, {buffer.address(), static_cast<uint32_t>(triangles.size())}, world.transforms);
        const int after = device->allocation_count();
        CHECK(done.has_value() == (n < 0));
        if (!done) {
            CHECK(done.error().code == Errc::out_of_memory);
            Rig rig(device);
            rig.update(scene, triangles, world.transforms);
            CHECK(scene.work().built == 3);
            const auto rays = Source(11).rays(500, 4);
            check_hits(triangles, rays, rig.trace(scene, rays));
        }
        return {before, after};
    };
    const auto [before, after] = run(-1);
    for (const int quarter : {0, 1, 2, 3})
        if (after > before) run(before + (after - 1 - before) * quarter / 3);
}
