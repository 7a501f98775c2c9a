// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/camera.h"

#include "tests/quad.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace aglow;

namespace {

using testing::add_quad;

enum class Facing { inwards, outwards };

/// The box from 0 to `size`.
Primitive box(vec3 size, Facing facing) {
    const float x = size.x, y = size.y, z = size.z;
    Primitive p;
    add_quad(p, {0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0});
    add_quad(p, {0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z});
    add_quad(p, {0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0});
    add_quad(p, {0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z});
    add_quad(p, {0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z});
    add_quad(p, {x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0});
    if (facing == Facing::outwards) {
        for (uvec3& t : p.triangles) std::swap(t.y, t.z);
        for (vec3& n : p.normals) n = -n;
    }
    return p;
}

Scene scene_of(Primitive primitive) {
    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].primitives.push_back(std::move(primitive));
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    return scene;
}

/// A camera of 90 degrees at (0, 0, 5) that looks along -Z.
void add_camera(Scene& scene, const std::string& name, float aspect) {
    Camera camera;
    camera.name = name;
    camera.y_fov = kPi / 2;
    camera.aspect = aspect;
    scene.cameras.push_back(camera);
    Node node;
    node.camera = static_cast<int>(scene.cameras.size()) - 1;
    node.name = "node of " + name;
    node.translation = {0, 0, 5};
    scene.nodes.push_back(node);
}

Result<View> view_of(const Scene& scene, std::string_view camera, int width, int height) {
    const Surfaces surfaces = pose(scene);
    const RayScene rays = RayScene::create(scene, surfaces).value();
    return choose_view(scene, surfaces, rays, camera, width, height, -1);
}

void check_near(vec3 a, vec3 b) {
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(length(a - b) < 1e-5f);
}

/// Pixel at which a perspective view shows a point.
vec2 project(const View& view, vec3 p) {
    const vec3 local = transform_point(inverse_affine(view.to_world), p);
    return {(local.x / -local.z / view.half_width + 1) / 2 * static_cast<float>(view.width),
            (1 - local.y / -local.z / view.half_height) / 2 * static_cast<float>(view.height)};
}

}  // namespace

TEST_CASE("the edges of a 90 degree image are 45 degrees off its middle") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "front", 0);
    const View view = view_of(scene, "front", 200, 100).value();
    const float half = std::sqrt(0.5f);
    check_near(view.ray(100, 50).direction, {0, 0, -1});
    check_near(view.ray(100, 0).direction, {0, half, -half});
    check_near(view.ray(100, 100).direction, {0, -half, -half});
    check_near(view.ray(200, 50).direction, normalize(vec3{2, 0, -1}));
    check_near(view.ray(3, 4).origin, {0, 0, 5});
}

TEST_CASE("a narrow image keeps the camera's horizontal field, a wide one its vertical field") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "wide", 2);
    const View same = view_of(scene, "0", 200, 100).value();
    CHECK(same.half_width == doctest::Approx(2));
    CHECK(same.half_height == doctest::Approx(1));
    const View wider = view_of(scene, "0", 400, 100).value();
    CHECK(wider.half_width == doctest::Approx(4));
    CHECK(wider.half_height == doctest::Approx(1));
    const View square = view_of(scene, "0", 100, 100).value();
    CHECK(square.half_width == doctest::Approx(2));
    CHECK(square.half_height == doctest::Approx(2));
}

TEST_CASE("an orthographic image shows all of its magnification") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "plan", 0);
    scene.cameras[0].perspective = false;
    scene.cameras[0].x_mag = 3;
    scene.cameras[0].y_mag = 2;
    const View view = view_of(scene, "plan", 100, 100).value();
    check_near(view.ray(0, 50).origin, {-3, 0, 5});
    check_near(view.ray(50, 0).origin, {0, 3, 5});
    check_near(view.ray(0, 0).direction, {0, 0, -1});
    const View wide = view_of(scene, "plan", 400, 100).value();
    check_near(wide.ray(200, 0).origin, {0, 2, 5});
}

TEST_CASE("scale and mirroring of a camera's nodes do not change its picture") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "front", 0);
    const View plain = view_of(scene, "front", 64, 64).value();
    scene.nodes[1].scale = {-2, 3, 0.1f};
    const View scaled = view_of(scene, "front", 64, 64).value();
    for (vec2 p : {vec2{0, 0}, vec2{50, 10}})
        check_near(scaled.ray(p.x, p.y).direction, plain.ray(p.x, p.y).direction);
}

TEST_CASE("cameras are found by number, by name and by the name of their node") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "first", 0);
    add_camera(scene, "second", 0);
    scene.nodes[2].translation = {7, 0, 0};
    CHECK(view_of(scene, "1", 8, 8)->ray(4, 4).origin.x == 7);
    CHECK(view_of(scene, "second", 8, 8)->ray(4, 4).origin.x == 7);
    CHECK(view_of(scene, "node of second", 8, 8)->ray(4, 4).origin.x == 7);
    CHECK(view_of(scene, "auto", 8, 8)->ray(4, 4).origin.x == 0);
}

TEST_CASE("a camera that does not exist or stands outside the active scene is an error") {
    Scene scene = scene_of(box({1, 1, 1}, Facing::outwards));
    add_camera(scene, "first", 0);
    add_camera(scene, "hidden", 0);
    scene.nodes[2].in_scene = false;
    for (const char* name : {"2", "-1", "1", "hidden", "third", ""}) {
        CAPTURE(name);
        const auto view = view_of(scene, name, 8, 8);
        REQUIRE(!view);
        CHECK(view.error().code == Errc::bad_argument);
        CHECK(view.error().message.find("0 \"first\"") != std::string::npos);
    }
    CHECK(!view_of(scene, "auto", 0, 8));
}

TEST_CASE("an object without a camera is framed whole and tightly, at every scale") {
    for (float scale : {1e-3f, 1.0f, 1e3f})
        for (int width : {50, 100, 300}) {
            CAPTURE(scale);
            CAPTURE(width);
            const vec3 size = vec3{2, 1, 3} * scale;
            const View view =
                view_of(scene_of(box(size, Facing::outwards)), "auto", width, 100).value();
            float closest = kInfinity;  // share of the image between a corner and the nearest edge
            for (int i = 0; i < 8; ++i) {
                const vec2 p =
                    project(view, size * vec3{float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)});
                const float w = static_cast<float>(width);
                closest = std::min({closest, p.x / w, 1 - p.x / w, p.y / 100, 1 - p.y / 100});
            }
            CHECK(closest > 0.01f);
            CHECK(closest < 0.05f);
            // From above, the front and the right.
            const vec3 away = view.ray(1, 1).origin - size * 0.5f;
            CHECK(std::min({away.x, away.y, away.z}) > 0);
        }
}

TEST_CASE("a closed room is seen from inside, looking across") {
    for (float scale : {1e-3f, 1.0f, 1e3f}) {
        CAPTURE(scale);
        const vec3 size = vec3{6, 3, 4} * scale;
        const View view = view_of(scene_of(box(size, Facing::inwards)), "auto", 160, 120).value();
        const vec3 eye = view.ray(0, 0).origin / scale;
        CHECK(eye.y == doctest::Approx(1.8).epsilon(0.03));
        CHECK(std::abs(eye.x - 3) > 1.5f);  // in a corner
        CHECK(std::abs(eye.x - 3) < 3);
        CHECK(std::abs(eye.z - 2) > 1);
        CHECK(std::abs(eye.z - 2) < 2);
        CHECK(view.half_height == doctest::Approx(std::tan(75.0 / 2 * 3.14159265 / 180)));
        const vec3 to_middle = normalize(vec3{3, eye.y, 2} - eye);
        CHECK(dot(view.ray(80, 60).direction, to_middle) > 0.95f);
    }
}

TEST_CASE("a room with one side open is seen through it, whole") {
    const vec3 size = {3, 3, 4};
    Primitive room = box(size, Facing::inwards);
    room.triangles.erase(room.triangles.begin() + 6, room.triangles.begin() + 8);  // z = 4
    const View view = view_of(scene_of(room), "auto", 160, 120).value();
    const Ray middle = view.ray(80, 60);
    CHECK(middle.direction.z < -0.999f);
    CHECK(middle.origin.z > 4);
    for (int i = 0; i < 8; ++i) {
        const vec2 p = project(view, size * vec3{float(i & 1), float(i >> 1 & 1), float(i >> 2)});
        CHECK(std::min({p.x, 160 - p.x, p.y, 120 - p.y}) > 0);
    }
}

TEST_CASE("a scene without triangles still has a view") {
    Scene empty;
    const View view = view_of(empty, "auto", 16, 16).value();
    CHECK(std::isfinite(view.ray(8, 8).direction.x));
    CHECK(length(view.ray(0, 0).direction) == doctest::Approx(1));
}
