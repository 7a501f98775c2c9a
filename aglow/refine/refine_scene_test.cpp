// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace aglow;
using namespace aglow::refine::testing;

TEST_CASE("a level makes four triangles of one, in every primitive") {
    const Scene scene = cube();
    for (const RefineScheme scheme : kSchemes)
        for (int level = 1; level <= 3; ++level) {
            CAPTURE(static_cast<int>(scheme));
            const Scene fine = refined(scene, scheme, level);
            // Catmull-Clark makes three quads of a triangle, which are six triangles.
            const size_t each =
                scheme == RefineScheme::catmull_clark ? 6u << 2 * (level - 1) : 1u << 2 * level;
            CHECK(fine.meshes[0].primitives[0].triangles.size() == 10 * each);
            CHECK(fine.meshes[0].primitives[1].triangles.size() == 2 * each);
        }
    RefineOptions quads;
    quads.scheme = RefineScheme::catmull_clark;
    quads.control.quads = true;
    quads.level = 2;
    CHECK(triangle_count(refined(scene, quads)) == 12 * 16);
}

TEST_CASE("primitives and seams meet bitwise") {
    const Scene scene = cube();
    for (const RefineScheme scheme : kSchemes) {
        CAPTURE(static_cast<int>(scheme));
        const Scene fine = refined(scene, scheme, 3);
        CHECK(open_edges(pose(fine)) == 0);
        for (const Primitive& p : fine.meshes[0].primitives)
            for (const vec3 n : p.normals) CHECK(length(n) == doctest::Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("subdivision stays within the control mesh, and its limit inside that") {
    const Scene scene = cube();
    RefineOptions options;
    for (const RefineScheme scheme : {RefineScheme::loop, RefineScheme::catmull_clark}) {
        options.scheme = scheme;
        options.level = 2;
        float reach[2] = {0, 0};
        for (const bool limit : {false, true}) {
            options.limit = limit;
            for (const vec3 p : pose(refined(scene, options)).positions)
                for (const float x : {p.x, p.y, p.z})
                    reach[limit ? 1 : 0] = std::max(reach[limit ? 1 : 0], std::fabs(x));
        }
        CHECK(reach[0] < 1);
        CHECK(reach[1] < reach[0]);
    }
}

TEST_CASE("creases keep a cube a cube, with a normal for each side") {
    RefineOptions options;
    options.level = 2;
    for (const bool by_angle : {false, true}) {
        options.control = {};
        if (by_angle) options.control.crease_angle = 0.5f;
        options.control.crease_at_normals = !by_angle;
        const Scene fine = refined(cube(), options);
        for (const Primitive& p : fine.meshes[0].primitives)
            for (size_t v = 0; v < p.positions.size(); ++v) {
                const vec3 x = p.positions[v], n = p.normals[v];
                const float largest = std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
                CHECK(largest == doctest::Approx(1).epsilon(1e-6));
                CHECK(dot(x, n) == doctest::Approx(1).epsilon(1e-5));
            }
    }
}

TEST_CASE("creases that a file tags keep a cube a cube, as those of its angles do") {
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives)
        for (uint32_t side = 0; side < p.positions.size(); side += 4)
            for (uint32_t i = 0; i < 4; ++i)
                p.creases.push_back({side + i, side + (i + 1) % 4, kSharp});
    RefineOptions options;
    const Scene tagged = refined(scene, options);
    options.control.crease_at_normals = true;
    const Scene by_normals = refined(cube(), options);
    for (size_t i = 0; i < 2; ++i) {
        const Primitive& p = tagged.meshes[0].primitives[i];
        CHECK(p.positions == by_normals.meshes[0].primitives[i].positions);
        CHECK(p.normals == by_normals.meshes[0].primitives[i].normals);
    }
}

TEST_CASE("texture coordinates keep the outline of their islands, and vertices are shared inside") {
    const Scene fine = refined(cube(), RefineScheme::loop, 2);
    const Primitive& top = fine.meshes[0].primitives[1];
    CHECK(top.positions.size() == 5 * 5);
    std::set<std::pair<float, float>> border;
    for (const vec2 uv : top.texcoords[0]) {
        CHECK(std::min(uv.x, uv.y) >= 0);
        CHECK(std::max(uv.x, uv.y) <= 1);
        if (uv.x == 0 || uv.x == 1 || uv.y == 0 || uv.y == 1) border.emplace(uv.x, uv.y);
    }
    CHECK(border.size() == 16);
    CHECK(border.contains({0.25f, 0.0f}));
}

TEST_CASE("white stays white, and no colour gets brighter than it") {
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives)
        p.colors.assign(p.positions.size(), {1, 1, 1, 1});
    for (const RefineScheme scheme : kSchemes) {
        const Scene fine = refined(scene, scheme, 3);
        for (const Primitive& p : fine.meshes[0].primitives)
            for (const vec4 c : p.colors)
                for (const float channel : {c.x, c.y, c.z, c.w}) {
                    CHECK(channel <= 1);
                    CHECK(channel == doctest::Approx(1).epsilon(1e-6));
                }
    }
}

TEST_CASE("a morph target at weight 1 is its shape, refined") {
    Scene scene = cube();
    Scene shape = scene;
    for (size_t i = 0; i < 2; ++i) {
        Primitive& p = scene.meshes[0].primitives[i];
        MorphTarget target;
        for (vec3& x : shape.meshes[0].primitives[i].positions) {
            const vec3 delta{0.5f * x.y, 0, 0.25f * x.x * x.y};
            target.positions.push_back(delta);
            x = x + delta;
        }
        p.targets.push_back(std::move(target));
    }
    scene.meshes[0].weights = {1};
    for (const RefineScheme scheme : kSchemes) {
        CAPTURE(static_cast<int>(scheme));
        const Surfaces moved = pose(refined(scene, scheme, 2));
        const Surfaces still = pose(refined(shape, scheme, 2));
        REQUIRE(moved.positions.size() == still.positions.size());
        float worst = 0;
        for (size_t v = 0; v < moved.positions.size(); ++v)
            worst = std::max(worst, length(moved.positions[v] - still.positions[v]));
        CHECK(worst < 2e-6f);
    }
}

TEST_CASE("what is left of a crease goes on: levels one by one are levels at once") {
    Scene scene = cube();
    // Four edges of the top for ever, one of the bottom for a level and a half, a corner for 2.5.
    scene.meshes[0].primitives[1].creases = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    scene.meshes[0].primitives[0].creases = {{8, 9, 1.5f}};
    scene.meshes[0].primitives[0].corners = {{10, 2.5f}};
    for (const RefineScheme scheme : {RefineScheme::loop, RefineScheme::catmull_clark}) {
        const Scene once = refined(scene, scheme, 1);
        size_t creases = 0, corners = 0;
        for (const Primitive& p : once.meshes[0].primitives) {
            creases += p.creases.size();
            corners += p.corners.size();
            for (const SharpEdge& crease : p.creases)
                CHECK((crease.sharpness == kSharp || crease.sharpness == 0.5f));
            for (const SharpVertex& corner : p.corners) CHECK(corner.sharpness == 1.5f);
        }
        CHECK(creases == 2 * 5);
        CHECK(corners == 1);
        if (scheme == RefineScheme::catmull_clark) continue;  // its quads are triangles again
        const Scene twice = refined(once, scheme, 1), at_once = refined(scene, scheme, 2);
        const auto places = [](const Scene& of) {
            std::vector<Point> all;
            for (const vec3 p : pose(of).positions) all.push_back(point(p));
            return all;
        };
        const std::vector<Point> all = places(at_once);
        for (const Point& a : places(twice)) {
            float nearest = 1;
            for (const Point& b : all)
                nearest = std::min(nearest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
            CHECK(nearest < 1e-6f);
        }
    }
}

TEST_CASE("a mesh without tags gets none, whatever the options keep sharp") {
    RefineOptions options;
    options.control.crease_angle = 0.5f;
    const Scene fine = refined(cube(), options);
    for (const Primitive& p : fine.meshes[0].primitives) {
        CHECK(p.corners.empty());
    }
}

TEST_CASE("what makes no sense is refused with what to do") {
    const Scene scene = cube();
    const auto says = [&](const RefineOptions& options) {
        const auto result = refine_scene(scene, options);
        REQUIRE(!result);
        CHECK(result.error().code == Errc::bad_argument);
        return result.error().message;
    };
    RefineOptions options;
    options.level = 0;
    CHECK(says(options).find("outside 1 to 10") != std::string::npos);
    options = {};
    options.scheme = RefineScheme::pn;
    options.limit = true;
    CHECK(says(options).find("limit") != std::string::npos);
    options = {};
    options.control.quads = true;
    CHECK(says(options).find("catmull-clark") != std::string::npos);
    options = {};
    options.displacement.emplace();
    options.field.emplace();
    CHECK(says(options).find("map or by a function") != std::string::npos);
    options = {};
    options.pattern.irregular = true;
    CHECK(says(options).find("pn, st, phong") != std::string::npos);
    options = {};
    options.scheme = RefineScheme::pn;
    options.pattern.eye.emplace();
    CHECK(says(options).find("irregular") != std::string::npos);
    options.pattern.irregular = options.share = true;
    CHECK(says(options).find("shared") != std::string::npos);
    options.share = false;
    options.pattern = {};
    options.pattern.tolerance = 0.0f;
    CHECK(says(options).find("above 0") != std::string::npos);
    options.pattern.tolerance = 0.1f;
    options.level = 8;
    CHECK(says(options).find("lower level") != std::string::npos);
    options.level = 2;
    options.field.emplace();
    CHECK(says(options).find("displaced") != std::string::npos);
    Scene large = scene;
    large.meshes.resize(20, scene.meshes[0]);
    options = {};
    options.level = 10;
    const auto result = refine_scene(large, options);
    REQUIRE(!result);
    // 240 triangles times 4^10
    CHECK(result.error().message.find("251658240") != std::string::npos);
    CHECK(result.error().message.find("level 9 fits") != std::string::npos);
}

TEST_CASE("work ends when it is cancelled") {
    const std::atomic<bool> cancel = true;
    Monitor monitor;
    monitor.cancel = &cancel;
    const auto result = refine_scene(cube(), {}, monitor);
    REQUIRE(!result);
    CHECK(result.error().code == Errc::cancelled);
}
