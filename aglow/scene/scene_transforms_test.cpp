// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/scene.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <cmath>

using namespace aglow;

namespace {

struct Point {
    double x, y, z;
};

double component(double range) { return *rc::gen::inRange(-1000, 1001) / 1000.0 * range; }

vec4 random_rotation() {
    const double x = component(1), y = component(1), z = component(1), w = component(1) + 1.5;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    return {static_cast<float>(x / length), static_cast<float>(y / length),
            static_cast<float>(z / length), static_cast<float>(w / length)};
}

/// Rotates by the sandwich product, in double: p + 2 q x (q x p + w p).
Point rotate(vec4 q, Point p) {
    const auto turn = [&](Point v) {
        return Point{q.y * v.z - q.z * v.y, q.z * v.x - q.x * v.z, q.x * v.y - q.y * v.x};
    };
    const Point inner = turn(p);
    const Point outer = turn({inner.x + q.w * p.x, inner.y + q.w * p.y, inner.z + q.w * p.z});
    return {p.x + 2 * outer.x, p.y + 2 * outer.y, p.z + 2 * outer.z};
}

/// Where the chain of parents puts a point: scaled, turned and moved once per ancestor.
Point place(const Scene& scene, int i, Point p) {
    while (i >= 0) {
        const Node& node = scene.nodes[static_cast<size_t>(i)];
        const Point turned =
            rotate(node.rotation, {p.x * node.scale.x, p.y * node.scale.y, p.z * node.scale.z});
        p = {turned.x + node.translation.x, turned.y + node.translation.y,
             turned.z + node.translation.z};
        i = node.parent;
    }
    return p;
}

void check_close(vec3 a, Point b, double tolerance) {
    CHECK(std::abs(a.x - b.x) <= tolerance);
    CHECK(std::abs(a.y - b.y) <= tolerance);
    CHECK(std::abs(a.z - b.z) <= tolerance);
}

/// One node that one channel moves.
Scene animated(Path path, Interpolation interpolation, std::vector<float> times,
               std::vector<float> values) {
    Scene scene;
    scene.nodes.resize(1);
    Animation animation;
    animation.channels.push_back({0, path, interpolation, std::move(times), std::move(values)});
    scene.animations.push_back(std::move(animation));
    return scene;
}

vec3 origin_at(const Scene& scene, double time) {
    return transform_point(world_transforms(scene, time)[0], {0, 0, 0});
}

vec3 x_axis_at(const Scene& scene, double time) {
    return transform_direction(world_transforms(scene, time)[0], {1, 0, 0});
}

}  // namespace

TEST_CASE("world transforms are the chain of every ancestor's scale, turn and move") {
    const bool holds = rc::check([] {
        Scene scene;
        const auto count = *rc::gen::inRange(1, 30);
        for (int i = 0; i < count; ++i) {
            Node node;
            // Parents stand before and after their children in the file.
            node.translation = {static_cast<float>(component(10)),
                                static_cast<float>(component(10)),
                                static_cast<float>(component(10))};
            node.rotation = random_rotation();
            node.scale = {static_cast<float>(component(1.5)), static_cast<float>(component(1.5)),
                          static_cast<float>(component(1.5))};  // negative ones mirror
            node.parent = i == 0 ? -1 : *rc::gen::inRange(-1, i);
            scene.nodes.push_back(node);
        }
        for (int i = 0; i < count; ++i)
            if (const int parent = scene.nodes[static_cast<size_t>(i)].parent; parent >= 0)
                scene.nodes[static_cast<size_t>(parent)].children.push_back(i);

        const std::vector<mat4> world = world_transforms(scene);
        RC_ASSERT(world.size() == static_cast<size_t>(count));
        for (int i = 0; i < count; ++i) {
            double scale = 1;  // of the coordinates on the way
            for (int k = i; k >= 0; k = scene.nodes[static_cast<size_t>(k)].parent)
                scale = scale * 1.5 + 10;
            const vec3 p = transform_point(world[static_cast<size_t>(i)], {1, -2, 3});
            const Point q = place(scene, i, {1, -2, 3});
            const double error = std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z);
            RC_ASSERT(error <= 1e-6 * scale);
        }
    });
    CHECK(holds);
}

TEST_CASE("a matrix takes the place of translation, rotation and scale") {
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].has_matrix = true;
    scene.nodes[0].matrix = translation({5, 6, 7});
    scene.nodes[0].translation = {100, 100, 100};
    check_close(origin_at(scene, -1), {5, 6, 7}, 0);
}

TEST_CASE("chains of 200 000 nodes are composed") {
    Scene scene;
    const int count = 200000;
    scene.nodes.resize(count);
    for (int i = 0; i < count; ++i) {
        Node& node = scene.nodes[static_cast<size_t>(i)];
        node.translation = {0.5f, 0, 0};
        node.parent = i - 1;
        if (i + 1 < count) node.children = {i + 1};
    }
    const vec3 end = transform_point(world_transforms(scene).back(), {0, 0, 0});
    check_close(end, {100000, 0, 0}, 0);
}

TEST_CASE("linear keys are joined by straight lines and held at their ends") {
    const Scene scene =
        animated(Path::translation, Interpolation::linear, {1, 3}, {0, 0, 0, 4, -8, 2});
    check_close(origin_at(scene, 0), {0, 0, 0}, 0);
    check_close(origin_at(scene, 1.5), {1, -2, 0.5}, 1e-6);
    check_close(origin_at(scene, 9), {4, -8, 2}, 0);
    // A negative time asks for the rest pose, not for the first key.
    Scene rest = scene;
    rest.nodes[0].translation = {7, 7, 7};
    check_close(origin_at(rest, -1), {7, 7, 7}, 0);
}

TEST_CASE("step keys hold until the next one") {
    const Scene scene =
        animated(Path::translation, Interpolation::step, {0, 1, 2}, {1, 0, 0, 2, 0, 0, 3, 0, 0});
    CHECK(origin_at(scene, 0.999).x == 1);
    CHECK(origin_at(scene, 1).x == 2);
    CHECK(origin_at(scene, 5).x == 3);
}

TEST_CASE("rotations turn at constant speed along the shorter arc") {
    const float s = std::sqrt(0.5f);
    // From 0 to 90 degrees about y; the second key is given with the opposite sign, which stands
    // for the same rotation and must not lead the long way round.
    for (const float sign : {1.0f, -1.0f}) {
        const Scene scene = animated(Path::rotation, Interpolation::linear, {0, 1},
                                     {0, 0, 0, 1, 0, sign * s, 0, sign * s});
        for (const double t : {0.0, 0.25, 0.5, 1.0}) {
            const double angle = t * 3.14159265358979 / 2;
            check_close(x_axis_at(scene, t), {std::cos(angle), 0, -std::sin(angle)}, 1e-6);
        }
    }
}

TEST_CASE("cubic splines reproduce any cubic polynomial") {
    // p(t) = t^3 - 2 t^2 + 3 t + 1 on keys 1 and 3: values 3, 19; slopes 2, 18.
    const Scene scene = animated(Path::translation, Interpolation::cubic_spline, {1, 3},
                                 {2, 0, 0, 3, 0, 0, 2, 0, 0,  //
                                  18, 0, 0, 19, 0, 0, 18, 0, 0});
    for (const double t : {1.0, 1.3, 2.0, 2.9, 3.0}) {
        const double expected = t * t * t - 2 * t * t + 3 * t + 1;
        CHECK(origin_at(scene, t).x == doctest::Approx(expected).epsilon(1e-6));
    }
    CHECK(origin_at(scene, 0).x == doctest::Approx(3));
    CHECK(origin_at(scene, 4).x == doctest::Approx(19));
}

TEST_CASE("animated scale multiplies the children's places") {
    Scene scene = animated(Path::scale, Interpolation::linear, {0, 1}, {1, 1, 1, -3, 1, 1});
    scene.nodes.resize(2);
    scene.nodes[0].children = {1};
    scene.nodes[1].parent = 0;
    scene.nodes[1].translation = {2, 0, 0};
    const vec3 p = transform_point(world_transforms(scene, 1)[1], {0, 0, 0});
    check_close(p, {-6, 0, 0}, 1e-6);
}
