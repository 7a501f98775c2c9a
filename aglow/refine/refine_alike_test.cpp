// SPDX-License-Identifier: Apache-2.0
// Meshes that are refined and stored once.
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

#include <doctest/doctest.h>

#include <vector>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

/// A drum, the same turned and moved as an exporter bakes it into vertices, one of another
/// material, one that is larger, and an open one that is moved.
Scene drums() {
    constexpr vec4 kTurn = {0.48f, -0.6f, 0, 0.64f};
    Scene scene = drum();
    scene.meshes.resize(5, scene.meshes[0]);
    const mat4 motion = compose({3, -1, 7}, kTurn, {1, 1, 1});
    Primitive& moved = scene.meshes[1].primitives[0];
    for (vec3& p : moved.positions) p = transform_point(motion, p);
    for (vec3& n : moved.normals) n = transform_direction(motion, n);
    scene.meshes[2].primitives[0].material = 7;
    for (vec3& p : scene.meshes[3].primitives[0].positions) p = p * 1.01f;
    Primitive& open = scene.meshes[4].primitives[0];
    for (vec3& p : open.positions) p.x += 2;
    open.triangles.pop_back();
    scene.meshes.push_back(scene.meshes[4]);
    for (vec3& p : scene.meshes[5].primitives[0].positions) p.x += 2;
    for (int m = 1; m < 6; ++m) scene.nodes.emplace_back().mesh = m;
    scene.nodes[1].translation = {0, 1, 0};
    scene.nodes[1].name = "moved";
    return scene;
}

}  // namespace

TEST_CASE("sharing gives the same surface, from fewer meshes") {
    for (const RefineScheme scheme : kSchemes) {
        RefineOptions options;
        options.scheme = scheme;
        options.level = 2;
        const Scene apart = refined(drums(), options);
        options.share = true;
        const Scene shared = refined(drums(), options);
        // The moved drum alone is another, placed; the rest is as it was.
        CHECK(apart.nodes.size() == 6);
        REQUIRE(shared.nodes.size() == 7);
        CHECK(shared.nodes[1].mesh == -1);
        CHECK(shared.nodes[1].children == std::vector<int>{6});
        CHECK(shared.nodes[6].parent == 1);
        CHECK(shared.nodes[6].mesh == 1);
        CHECK(shared.nodes[6].name == "moved");
        const auto primitive = [](const Scene& of, size_t m) { return of.meshes[m].primitives[0]; };
        CHECK(same_geometry(primitive(shared, 1), primitive(shared, 0)));
        CHECK(same_geometry(primitive(shared, 2), primitive(shared, 0)));
        CHECK(primitive(shared, 2).material == 7);
        for (const size_t m : {3u, 4u, 5u})
            CHECK(same_geometry(primitive(shared, m), primitive(apart, m)));

        const Surfaces a = pose(apart), b = pose(shared);
        REQUIRE(a.triangles.size() == b.triangles.size());
        // Nodes come in another order: the placed one is last.
        Box box;
        for (const vec3 p : a.positions) box.add(p);
        const float size = length(box.hi - box.lo);
        const size_t each = primitive(apart, 0).positions.size();
        const size_t open = primitive(apart, 4).positions.size();
        REQUIRE(a.positions.size() == 4 * each + 2 * open);
        const auto there = [&](size_t v) {  // where vertex v of `apart` is in `shared`
            if (v < each) return v;
            return v < 2 * each ? v + 2 * each + 2 * open : v - each;
        };
        for (size_t v = 0; v < a.positions.size(); ++v)
            CHECK(length(a.positions[v] - b.positions[there(v)]) < 1e-6f * size);
    }
}

TEST_CASE("what tells copies apart is not shared") {
    RefineOptions options;
    options.share = true;
    const auto placed = [&](const Scene& scene) {
        return refined(scene, options).nodes.size() - scene.nodes.size();
    };
    CHECK(placed(drums()) == 1);
    Scene other = drums();
    other.meshes[1].primitives[0].colors[3].z = 1;
    CHECK(placed(other) == 0);
    other = drums();
    other.meshes[1].primitives[0].creases = {{0, 1, 2}};
    CHECK(placed(other) == 0);
    other = drums();
    for (vec3& p : other.meshes[1].primitives[0].positions) p.x = -p.x;  // mirrored
    CHECK(placed(other) == 0);
    other = drums();
    other.meshes[1].primitives[0].positions[5].y += 1e-4f;
    CHECK(placed(other) == 0);
    other = drums();
    other.nodes[1].instances = {mat4{}, mat4{}};
    CHECK(placed(other) == 0);
    options.field = shared::Displacement{};
    options.field->kind = shared::kSineDisplacement;
    options.field->amplitude = 0.1f;
    options.field->frequency = {1, 2, 3};
    CHECK(placed(drums()) == 0);
}

TEST_CASE("a node that carries more than a mesh keeps it, and every node that shows one moves it") {
    Scene scene = drums();
    scene.nodes.emplace_back().mesh = 1;
    scene.nodes[1].children = {2};
    scene.nodes[2].parent = 1;
    RefineOptions options;
    options.share = true;
    const Scene shared = refined(scene, options);
    REQUIRE(shared.nodes.size() == 9);
    CHECK(shared.nodes[1].children == std::vector<int>{2, 7});
    CHECK(shared.nodes[1].translation == vec3{0, 1, 0});
    CHECK(shared.nodes[8].parent == 6);
}
