// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/hidden_points.h"

#include "tests/quad.h"

#include <doctest/doctest.h>

using namespace aglow;

namespace {

using testing::add_quad;

/// A floor of 4 x 4 m that fills an atlas of 8 x 8 texels, and whatever stands on it.
struct Floor {
    Scene scene;
    Surfaces surfaces;
    Texels texels;

    explicit Floor(const Primitive& furniture) {
        Primitive floor;
        add_quad(floor, {0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0});
        floor.lightmap_uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
        Primitive other = furniture;
        other.lightmap_uvs.assign(other.positions.size(), {0, 0});
        scene.meshes.push_back({"floor", {floor, other}, {}});
        Node node;
        node.mesh = 0;
        scene.nodes.push_back(node);
        Atlas atlas;
        atlas.width = atlas.height = 8;
        atlas.placements.push_back({0, 0, 0, {8, 8}, {0, 0}});
        surfaces = pose(scene, -1, &atlas);
        texels = rasterize(surfaces, atlas, 16);
        const RayScene rays = *RayScene::create(scene, surfaces);
        drop_hidden_points(surfaces, scene, rays, texels);
    }
    size_t points_where(bool (*inside)(vec3)) const {
        size_t count = 0;
        for (const SurfacePoint at : texels.samples) count += inside(position(surfaces, at));
        return count;
    }
};

}  // namespace

TEST_CASE("points under a closed block go, and so do the texels it covers whole") {
    Primitive block;  // [1, 2.75]^2 x [0, 1], four sides and a top, fronts outward
    const float lo = 1, hi = 2.75f;
    add_quad(block, {lo, 1, lo}, {lo, 1, hi}, {hi, 1, hi}, {hi, 1, lo});
    add_quad(block, {lo, 0, lo}, {lo, 0, hi}, {lo, 1, hi}, {lo, 1, lo});
    add_quad(block, {hi, 0, hi}, {hi, 0, lo}, {hi, 1, lo}, {hi, 1, hi});
    add_quad(block, {lo, 0, hi}, {hi, 0, hi}, {hi, 1, hi}, {lo, 1, hi});
    add_quad(block, {hi, 0, lo}, {lo, 0, lo}, {lo, 1, lo}, {hi, 1, lo});
    const Floor floor(block);
    CHECK(floor.points_where([](vec3 p) {
        return p.x > 1.01f && p.x < 2.74f && p.z > 1.01f && p.z < 2.74f;
    }) == 0);
    CHECK(floor.texels.element_count() == 64 - 9);  // 3 x 3 texels of 0.5 m lie wholly inside
    CHECK(floor.points_where([](vec3 p) { return p.x < 1 || p.z < 1; }) == (64 - 36) * 16);
}

TEST_CASE("a floor under a low one-sided table keeps its light") {
    Primitive table;
    add_quad(table, {1, 0.2f, 1}, {1, 0.2f, 3}, {3, 0.2f, 3}, {3, 0.2f, 1});
    CHECK(Floor(table).texels.element_count() == 64);
}

TEST_CASE("a wall across a texel leaves the points of its greater side only") {
    Primitive wall;  // at x = 1.1: a fifth into the texels from 1.0 to 1.5
    add_quad(wall, {1.1f, 0, 0}, {1.1f, 0, 4}, {1.1f, 2, 4}, {1.1f, 2, 0});
    const Floor floor(wall);
    CHECK(floor.texels.element_count() == 64);
    CHECK(floor.points_where([](vec3 p) { return p.x > 1 && p.x < 1.1f && p.z < 3.9f; }) == 0);
    CHECK(floor.points_where([](vec3 p) { return p.x < 1; }) == 16 * 16);
}
