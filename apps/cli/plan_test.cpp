// SPDX-License-Identifier: Apache-2.0
#include "plan.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;
using namespace aglow::cli;

namespace {

Receiver sensor_at(float x, float y, float z) { return {{x, y, z}, {0, 1, 0}, {0, 1, 0}, 0}; }

Irradiance lux(float e) { return {{e, e, e}, {0, 0, 0}}; }

/// A horizontal square roof at height 3 over x, z in [-0.5, 1.5], and rays that meet it.
struct Roofed {
    Scene scene;
    Surfaces surfaces;

    Roofed() {
        Primitive roof;
        roof.positions = {{-0.5f, 3, -0.5f}, {-0.5f, 3, 1.5f}, {1.5f, 3, 1.5f}, {1.5f, 3, -0.5f}};
        roof.normals.assign(4, {0, 1, 0});
        roof.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene.meshes.push_back({"roof", {roof}, {}});
        Node node;
        node.mesh = 0;
        scene.nodes.push_back(node);
        surfaces = pose(scene);
    }
};

}  // namespace

TEST_CASE("a plan shows each sensor in its own cell, north at the top") {
    const Roofed world;
    const auto rays = RayScene::create(world.scene, world.surfaces);
    REQUIRE(rays.has_value());
    const std::vector<Receiver> sensors = {sensor_at(0, 0, 0), sensor_at(1, 0, 0),
                                           sensor_at(0, 0, 1)};
    const std::vector<Irradiance> values = {lux(10), lux(20), lux(30)};
    const Plan plan = plan_view(sensors, values, 1, *rays);
    const int side = plan.width / 2;
    REQUIRE(plan.width == 2 * side);
    REQUIRE(plan.height == 2 * side);
    const auto at = [&](int column, int row) {
        return plan.lux[static_cast<size_t>((row * side + side / 2) * plan.width + column * side +
                                            side / 2)];
    };
    CHECK(at(0, 0) == doctest::Approx(10));
    CHECK(at(1, 0) == doctest::Approx(20));  // +X is east: right
    CHECK(at(0, 1) == doctest::Approx(30));  // +Z is south: below
    CHECK(std::isnan(at(1, 1)));
}

TEST_CASE("a plan lifts the roof off and shows the table top, not the floor") {
    const Roofed world;
    const auto rays = RayScene::create(world.scene, world.surfaces);
    REQUIRE(rays.has_value());
    const std::vector<Receiver> sensors = {sensor_at(0, 0, 0), sensor_at(0, 0.7f, 0),
                                           sensor_at(0, 3.01f, 0)};
    const std::vector<Irradiance> values = {lux(5), lux(70), lux(9000)};
    const Plan plan = plan_view(sensors, values, 1, *rays);
    CHECK(plan.lux.front() == doctest::Approx(70));
}
