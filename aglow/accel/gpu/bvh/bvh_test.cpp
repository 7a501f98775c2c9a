// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/bvh/bvh.h"

#include "aglow/accel/gpu/testing/bvh_fixture.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

using namespace aglow;
using namespace aglow::accel::gpu;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

vec3 center_of(const shared::Triangle& t) { return (t.a + t.b + t.c) / 3.0f; }

/// Rays of all the kinds that go wrong: between random points in and around the triangles, along
/// axes, in planes of axes, at corners and edges, from points on triangles, with directions of any
/// length.
Queries rays_at(const Triangles& triangles, size_t count, uint32_t seed = 7) {
    Pcg32 random(seed);
    auto pick = [&]() -> const shared::Triangle& {
        return triangles[random.next() % triangles.size()];
    };
    shared::Bounds box = shared::empty_bounds();
    for (const auto& t : triangles) box = shared::united(box, shared::triangle_bounds(t));
    const vec3 middle = (box.lower + box.upper) * 0.5f;
    const vec3 size = box.upper - box.lower + vec3{1e-3f, 1e-3f, 1e-3f};
    auto anywhere = [&] { return middle + size * random_vector(random, -1, 1); };
    Queries rays(count);
    for (size_t i = 0; i < count; ++i) {
        vec3 from = anywhere();
        vec3 to = anywhere();
        if (i % 8 == 1) to = pick().a;
        if (i % 8 == 2) to = pick().b * 0.5f + pick().c * 0.5f;
        if (i % 8 == 3) from = center_of(pick());
        if (i % 8 == 4) to = vec3{from.x, from.y, to.z};
        if (i % 8 == 5) to = vec3{to.x, from.y, to.z};
        if (i % 8 == 6) {
            to = center_of(pick());
            from = vec3{from.x, to.y, to.z};
        }
        if (i % 8 == 7) {
            to = pick().c;
            from = vec3{to.x, from.y, to.z};
        }
        const float length = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1e-4f : 1e3f;
        rays[i] = {from, 0, (to - from) * length,
                   i % 5 == 0 ? 0.5f / length : std::numeric_limits<float>::infinity()};
        if (rays[i].direction == vec3{0, 0, 0}) rays[i].direction.x = length;
    }
    return rays;
}

bool agree(const shared::RayHit& found, const shared::RayHit& expected, float tolerance) {
    if (expected.triangle == shared::kNoTriangle) return found.triangle == shared::kNoTriangle;
    return found.triangle != shared::kNoTriangle &&
           std::abs(found.t - expected.t) <= tolerance * expected.t;
}

/// Hits are those of trying every triangle. On the device itself that is the same test with the
/// same rounding, so every hit has to agree however small the triangle; the host divides with
/// another rounding, by which a triangle smaller than the rounding error of its distance is missed
/// or hit, and agrees where triangles are larger than that.
enum class Triangle { any, larger_than_rounding };

void check_hits(BvhFixture& fixture, const Triangles& triangles, const Queries& rays,
                Triangle size = Triangle::larger_than_rounding) {
    const Hits hits = fixture.trace(rays);
    const Hits any = fixture.trace_any(rays);
    const Hits every = fixture.try_every_triangle(rays);
    size_t lost = 0, blocked = 0, unlike_host = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        lost += !agree(hits[i], every[i], 1e-6f);
        blocked += any[i].triangle != shared::kNoTriangle;
        blocked -= every[i].triangle != shared::kNoTriangle;
        if (size == Triangle::larger_than_rounding)
            unlike_host += !agree(hits[i], brute_force(triangles, rays[i]), 1e-5f);
    }
    CHECK(lost == 0);
    CHECK(blocked == 0);
    CHECK(unlike_host <= rays.size() / 1000);
}

/// What a tree must be, whatever the triangles.
struct Shape {
    std::vector<uint32_t> seen;  ///< how often each triangle occurs
    uint32_t depth = 0;
    size_t escaped = 0;  ///< triangles that stick out of a box above them
    size_t visited = 0;  ///< nodes
};

struct Box {
    std::array<double, 3> lower, upper;
};

bool contains(const Box& box, const shared::Triangle& t) {
    for (vec3 p : {t.a, t.b, t.c}) {
        const std::array<double, 3> q = {p.x, p.y, p.z};
        for (size_t k = 0; k < 3; ++k)
            if (q[k] < box.lower[k] || q[k] > box.upper[k]) return false;
    }
    return true;
}

Box child_box(const shared::BvhNode& node, uint32_t slot) {
    auto plane = [&](float origin, uint32_t axis, shared::uvec2 bytes) {
        const uint32_t exponent = (node.exponents >> (8 * axis)) & 255;
        return double{origin} +
               shared::slot_byte(bytes, slot) * std::ldexp(1.0, static_cast<int>(exponent) - 127);
    };
    return {{plane(node.origin.x, 0, node.lower_x), plane(node.origin.y, 1, node.lower_y),
             plane(node.origin.z, 2, node.lower_z)},
            {plane(node.origin.x, 0, node.upper_x), plane(node.origin.y, 1, node.upper_y),
             plane(node.origin.z, 2, node.upper_z)}};
}

void walk(std::span<const shared::BvhNode> nodes, std::span<const shared::BvhTriangle> triangles,
          uint32_t index, std::vector<Box>& boxes, Shape& shape) {
    REQUIRE(index < nodes.size());
    REQUIRE(boxes.size() < 64);
    ++shape.visited;
    shape.depth = std::max(shape.depth, static_cast<uint32_t>(boxes.size()) + 1);
    const shared::BvhNode& node = nodes[index];
    uint32_t child = node.child_base, triangle = node.triangle_base;
    for (uint32_t slot = 0; slot < 8; ++slot) {
        boxes.push_back(child_box(node, slot));
        const uint32_t leaf = shared::leaf_triangles(node.slots, slot);
        if (shared::is_node_slot(node.slots, slot)) {
            CHECK(leaf == 0);
            walk(nodes, triangles, child++, boxes, shape);
        }
        for (uint32_t k = 0; k < shared::kBvhLeafSize; ++k) {
            if (((leaf >> k) & 1) == 0) continue;
            const shared::BvhTriangle& t = triangles[triangle++];
            ++shape.seen[t.triangle];
            for (const Box& box : boxes) shape.escaped += !contains(box, {t.a, t.b, t.c});
        }
        boxes.pop_back();
    }
}

void check_shape(BvhFixture& fixture, const Triangles& triangles) {
    const auto nodes = fixture.nodes();
    Shape shape;
    shape.seen.resize(triangles.size());
    std::vector<Box> boxes;
    if (!nodes.empty()) walk(nodes, fixture.triangles(), 0, boxes, shape);
    for (size_t i = 0; i < triangles.size(); ++i)
        CHECK(shape.seen[i] == (shared::usable_triangle(triangles[i]) ? 1 : 0));
    CHECK(shape.escaped == 0);
    CHECK(shape.visited == nodes.size());
    CHECK(shape.depth <= fixture.bvh->depth());
    CHECK(fixture.bvh->depth() <= shared::kBvhMaxDepth);
}

Triangles flat(size_t count) {
    Triangles triangles = soup(count, 0.1f);
    for (auto& t : triangles) t.a.y = t.b.y = t.c.y = 0.25f;
    return triangles;
}

Triangles huge_and_tiny() {
    Triangles triangles = moved(soup(1000, 0.3f), 1e-3f, {0.5f, 0.5f, 0.5f});
    for (const auto& t : moved(soup(20, 2), 1e3f, {})) triangles.push_back(t);
    return triangles;
}

}  // namespace

TEST_CASE("a tree finds the hits that trying every triangle finds") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    struct Case {
        const char* name;
        Triangles triangles;
        Triangle size = Triangle::larger_than_rounding;
    };
    const Case cases[] = {
        {"one", soup(1, 1)},
        {"two", soup(2, 1)},
        {"three", soup(3, 1)},
        {"four", soup(4, 1)},
        {"seventeen", soup(17, 1)},
        {"a soup", soup(3000, 0.2f)},
        {"a soup of large ones", soup(300, 2)},
        {"all alike", Triangles(500, soup(1, 1)[0])},
        {"a plane", flat(1000)},
        {"a sphere", sphere(24, 48)},
        {"a cube", cube(10)},
        {"huge and tiny", huge_and_tiny(), Triangle::any},
        {"far from the origin", moved(soup(1000, 0.2f), 10, {1e6f, -1e6f, 1e6f})},
        {"a speck", moved(soup(500, 0.2f), 1e-6f, {})},
    };
    for (const Case& c : cases) {
        CAPTURE(std::string(c.name));
        fixture.build(c.triangles);
        check_shape(fixture, c.triangles);
        check_hits(fixture, c.triangles, rays_at(c.triangles, 3000), c.size);
    }
}

TEST_CASE("nothing is hit where there is nothing") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    fixture.build({});
    CHECK(fixture.bvh->stats().cells == 0);
    for (const auto& hit : fixture.trace(rays_at(soup(10, 1), 100)))
        CHECK(hit.triangle == shared::kNoTriangle);
}

TEST_CASE("triangles that are not finite or have no area are hit by nothing and harm no other") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    Triangles triangles = soup(600, 0.3f);
    const Triangles good = triangles;
    const float inf = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < triangles.size(); i += 4) {
        shared::Triangle& t = triangles[i];
        if (i % 16 == 0) t.a.x = kNan;
        if (i % 16 == 4) t.b.y = inf;
        if (i % 16 == 8) t = {t.a, t.a, t.c};
        if (i % 16 == 12) t.c.z = -3e38f;
    }
    fixture.build(triangles);
    check_shape(fixture, triangles);
    const Queries rays = rays_at(good, 3000);
    Triangles rest = triangles;
    for (auto& t : rest)
        if (!shared::usable_triangle(t)) t = {};
    check_hits(fixture, rest, rays);
    for (const auto& hit : fixture.trace(rays))
        CHECK((hit.triangle == shared::kNoTriangle || hit.triangle % 4 != 0));

    Triangles none(100, shared::Triangle{{kNan, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    fixture.build(none);
    check_hits(fixture, {}, rays);
}

TEST_CASE("after a refit rays hit what moved, wherever it went") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    const Triangles rest = soup(2000, 0.2f);
    fixture.build(rest);
    const uint64_t cells = fixture.bvh->stats().cells;

    Pcg32 random(3);
    Triangles waved = rest, scattered = rest;
    for (auto& t : waved) {
        const vec3 by = {0, 0.2f * std::sin(5 * t.a.x), 0};
        t = {t.a + by, t.b + by, t.c + by};
    }
    for (auto& t : scattered) {
        const vec3 by = random_vector(random, -50, 50);
        t = {t.a + by, t.b + by, t.c + by};
    }
    Triangles broken = rest;
    for (size_t i = 0; i < broken.size(); i += 3) broken[i].b.x = kNan;
    const Triangles point(rest.size(), shared::Triangle{});
    const std::array<const Triangles*, 5> poses = {&waved, &scattered, &broken, &point, &rest};
    for (const Triangles* pose : poses) {
        fixture.refit(*pose);
        CHECK(fixture.bvh->stats().cells == cells);
        check_hits(fixture, *pose, rays_at(pose == &point ? rest : *pose, 2000));
    }

    // Triangles that were left out of the tree take part once they are finite.
    fixture.build(broken);
    fixture.refit(rest);
    check_shape(fixture, rest);
    check_hits(fixture, rest, rays_at(rest, 1000));
}

TEST_CASE("the same triangles make the same tree every time") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    const Triangles triangles = soup(20000, 0.05f);
    auto bytes = [&] {
        fixture.build(triangles);
        const auto nodes = fixture.nodes();
        const auto order = fixture.triangles();
        std::string all(reinterpret_cast<const char*>(nodes.data()),
                        nodes.size() * sizeof(nodes[0]));
        return all.append(reinterpret_cast<const char*>(order.data()),
                          order.size() * sizeof(order[0]));
    };
    const std::string first = bytes();
    fixture.build(soup(30000, 0.1f, 9));
    for (int i = 0; i < 3; ++i) CHECK(bytes() == first);
}

TEST_CASE("no ray leaves a closed mesh, whichever edge or corner it goes for") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    struct Case {
        const char* name;
        Triangles triangles;
        vec3 middle;
        float scale;
    };
    const Case cases[] = {
        {"sphere", sphere(64, 128), {0, 0, 0}, 1},
        {"bumpy sphere", sphere(40, 90, 0.2f), {0, 0, 0}, 1},
        {"cube", cube(32), {0, 0, 0}, 1},
        {"cube far away", moved(cube(16), 100, {1e6f, 1e6f, 0}), {1e6f, 1e6f, 0}, 100},
    };
    for (const Case& c : cases) {
        CAPTURE(std::string(c.name));
        fixture.build(c.triangles);
        Pcg32 random(11);
        Queries rays(60000);
        for (size_t i = 0; i < rays.size(); ++i) {
            const auto& t = c.triangles[random.next() % c.triangles.size()];
            const vec3 from = c.middle + random_vector(random, -0.4f, 0.4f) * c.scale;
            const float k = random.uniform();
            vec3 to = i % 3 == 0 ? t.a : i % 3 == 1 ? t.a * k + t.b * (1 - k) : center_of(t);
            rays[i] = {from, 0, to - from, std::numeric_limits<float>::infinity()};
            if (i % 16 == 0) rays[i].direction = {i % 32 == 0 ? 1.0f : -1.0f, 0, 0};
            if (i % 16 == 1) rays[i].direction.y = 0;
        }
        size_t leaks = 0;
        for (const auto& hit : fixture.trace(rays)) leaks += hit.triangle == shared::kNoTriangle;
        CHECK(leaks == 0);
    }
}

TEST_CASE("the depth stays within a ray's stack even where triangles cannot be told apart") {
    vk::TestDevice device;
    if (!device) return;
    const Triangles alike(100000, soup(1, 1)[0]);
    // Every eighth triangle half as far from the origin and half as large as the one before it.
    Triangles shrinking = soup(100, 0.3f);
    for (size_t i = 0; i < shrinking.size(); ++i) {
        const float scale = std::ldexp(1.0f, -static_cast<int>(i) / 8);
        shrinking[i] = moved({shrinking[i]}, scale, vec3{scale, scale, scale})[0];
    }
    for (BvhQuality quality : {BvhQuality::clustered, BvhQuality::morton, BvhQuality::shallow}) {
        BvhFixture fixture(device, quality);
        fixture.build(alike);
        check_shape(fixture, alike);
        fixture.build(shrinking);
        check_shape(fixture, shrinking);
        check_hits(fixture, shrinking, rays_at(shrinking, 1000));
    }
}

TEST_CASE("clustering spares rays nodes that the order of Morton codes makes them visit") {
    vk::TestDevice device;
    if (!device) return;
    const Triangles triangles = huge_and_tiny();
    const Queries rays = rays_at(triangles, 4000);
    BvhFixture clustered(device), morton(device, BvhQuality::morton);
    clustered.build(triangles);
    morton.build(triangles);
    clustered.trace(rays);
    morton.trace(rays);
    CHECK(clustered.counts().steps + clustered.counts().triangles <
          morton.counts().steps + morton.counts().triangles);
}

TEST_CASE("a sibling is an empty tree that is built for itself") {
    vk::TestDevice device;
    if (!device) return;
    BvhFixture fixture(device);
    const Triangles first = soup(500, 0.3f), second = soup(700, 0.2f, 5);
    fixture.build(first);
    auto sibling = fixture.bvh->sibling();
    CHECK(sibling->stats().cells == 0);
    demand(sibling->build(fixture.stream, fixture.upload(second)));
    fixture.stream.barrier();
    CHECK(sibling->stats().references == second.size());
    check_hits(fixture, first, rays_at(first, 500));
}

TEST_CASE("memory that cannot be had is an error that says how much is needed") {
    int allocations = 0;
    for (int n = 0; n == 0 || n < allocations; ++n) {
        vk::DeviceOptions options;
        vk::TestDevice probe;
        if (!probe) return;
        const Triangles triangles = soup(100, 0.3f);
        {
            BvhFixture fixture(probe);
            const TriangleSpan span = fixture.upload(triangles);
            const int before = probe->allocation_count();
            demand(fixture.bvh->build(fixture.stream, span));
            allocations = probe->allocation_count() - before;
            options.faults.fail_allocation = before + n;
            demand(fixture.stream.finish());
        }
        vk::TestDevice device(options);
        BvhFixture fixture(device);
        const TriangleSpan span = fixture.upload(triangles);
        const Status failed = fixture.bvh->build(fixture.stream, span);
        REQUIRE(!failed.has_value());
        CHECK(failed.error().code == Errc::out_of_memory);
        CHECK(failed.error().message.find("bytes") != std::string::npos);
        CHECK(fixture.bvh->stats().cells == 0);
        // The stream may be what lacked memory, and stays failed.
        fixture.stream = device.stream();
        fixture.build(triangles);
        check_hits(fixture, triangles, rays_at(triangles, 200));
    }
}
