// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/ray_scene.h"

#include "aglow/accel/cpu/embree_scene.h"
#include "aglow/core/random.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;

namespace {

/// A unit square in the plane y = 0 facing up, with texture coordinates.
Scene square(AlphaMode mode, const TextureImage& image = {}) {
    Scene scene;
    Material material;
    material.alpha_mode = mode;
    if (image.width > 0) {
        scene.images.push_back(image);
        scene.textures.push_back({0, Wrap::clamp_to_edge, Wrap::clamp_to_edge, Filter::nearest});
        material.base_color_texture.texture = 0;
    }
    scene.materials.push_back(material);
    Primitive p;
    p.material = 0;
    p.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
    p.normals.assign(4, {0, 1, 0});
    p.texcoords = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back({"square", {p}, {}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

TextureImage half_transparent() { return {"half", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}}; }

}  // namespace

TEST_CASE("a hit names its triangle, distance, barycentrics and side") {
    const Scene scene = square(AlphaMode::opaque);
    const Surfaces surfaces = pose(scene);
    const RayScene rays = *RayScene::create(scene, surfaces);
    const auto above = rays.intersect({{0.25f, 2, 0.75f}, {0, -1, 0}});
    REQUIRE(above);
    CHECK(above->front);
    CHECK(above->distance == doctest::Approx(2));
    CHECK(length(position(surfaces, above->at) - vec3{0.25f, 0, 0.75f}) < 1e-6f);
    const auto below = rays.intersect({{0.75f, -3, 0.25f}, {0, 1, 0}});
    REQUIRE(below);
    CHECK_FALSE(below->front);
    CHECK(below->distance == doctest::Approx(3));
    CHECK_FALSE(rays.intersect({{1.5f, 2, 0.5f}, {0, -1, 0}}));
}

TEST_CASE("a ray ends where it is told to") {
    const Scene scene = square(AlphaMode::opaque);
    const Surfaces surfaces = pose(scene);
    const RayScene rays = *RayScene::create(scene, surfaces);
    CHECK(rays.visibility({{0.5f, 1, 0.5f}, {0, -1, 0}, 1.001f}) == 0);
    CHECK(rays.visibility({{0.5f, 1, 0.5f}, {0, -1, 0}, 0.999f}) == 1);
}

TEST_CASE("a ray does not meet what it starts on") {
    const Scene scene = square(AlphaMode::opaque);
    const Surfaces surfaces = pose(scene);
    const RayScene rays = *RayScene::create(scene, surfaces);
    for (const float y : {-1.0f, -0.25f, 0.25f, 1.0f}) {
        const Ray ray{{0.25f, 0, 0.5f}, normalize(vec3{1, y, 0.5f})};
        CHECK_FALSE(rays.intersect(ray));
        CHECK(rays.visibility(ray) == 1);
    }
    CHECK(rays.intersect({{0.25f, 1e-20f, 0.5f}, {0, -1, 0}}));
}

TEST_CASE("a mask lets rays pass where its texture is transparent and only there") {
    const Scene scene = square(AlphaMode::mask, half_transparent());
    const Surfaces surfaces = pose(scene);
    const RayScene rays = *RayScene::create(scene, surfaces);
    for (float z : {0.1f, 0.5f, 0.9f}) {
        CHECK(rays.visibility({{0.25f, 1, z}, {0, -1, 0}}) == 0);
        CHECK(rays.visibility({{0.75f, 1, z}, {0, -1, 0}}) == 1);
        CHECK_FALSE(rays.intersect({{0.75f, 1, z}, {0, -1, 0}}));
    }
}

TEST_CASE("light passes n blended surfaces of alpha 0.3 as 0.7 to the n") {
    Scene scene = square(AlphaMode::blend);
    scene.materials[0].base_color.w = 0.3f;
    for (int n = 1; n <= 3; ++n) {
        const Surfaces surfaces = pose(scene);
        const RayScene rays = *RayScene::create(scene, surfaces);
        CHECK(rays.visibility({{0.3f, 1, 0.4f}, {0, -1, 0}}) == doctest::Approx(std::pow(0.7, n)));
        Node node;
        node.mesh = 0;
        node.translation = {0, -static_cast<float>(n), 0};
        scene.nodes.push_back(node);
    }
}

TEST_CASE("a blended surface of alpha 0.3 is hit by three rays in ten, the same ones every time") {
    Scene scene = square(AlphaMode::blend);
    scene.materials[0].base_color.w = 0.3f;
    const Surfaces surfaces = pose(scene);
    const RayScene rays = *RayScene::create(scene, surfaces);
    Pcg32 random(5);
    int stopped = 0;
    constexpr int kRays = 20000;
    for (int i = 0; i < kRays; ++i) {
        const Ray ray{{random.uniform(), 1, random.uniform()}, {0, -1, 0}};
        const bool blocked = rays.intersect(ray).has_value();
        CHECK(blocked == rays.intersect(ray).has_value());
        stopped += blocked;
    }
    CHECK(stopped == doctest::Approx(0.3 * kRays).epsilon(0.04));  // 4 standard deviations: 0.043
}

TEST_CASE("rays traced in packets find what they find one by one") {
    Scene scene = square(AlphaMode::blend, half_transparent());
    scene.materials[0].base_color.w = 0.6f;
    scene.materials.push_back({});
    Primitive wall = scene.meshes[0].primitives[0];  // opaque, below the square
    wall.material = 1;
    for (vec3& p : wall.positions) p = {p.x * 0.5f, -1, p.z};
    scene.meshes[0].primitives.push_back(wall);
    const Surfaces surfaces = pose(scene);
    const RayScene scene_rays = *RayScene::create(scene, surfaces);
    Pcg32 random(9);
    for (const size_t count : {0, 1, 7, 8, 9, 16, 203}) {
        std::vector<Ray> rays;
        for (size_t i = 0; i < count; ++i) {
            const vec3 to{random.uniform() * 1.2f, -1, random.uniform() * 1.2f};
            const vec3 line = to - vec3{0.5f, 1, 0.5f};
            rays.push_back({{0.5f, 1, 0.5f}, normalize(line), i % 5 == 0 ? 1.5f : kInfinity});
        }
        std::vector<accel::cpu::SurfaceHit> hits(count);
        std::vector<float> passing(count);
        scene_rays.cpu().intersect(rays, hits.data());
        scene_rays.cpu().visibility(rays, passing.data());
        for (size_t i = 0; i < count; ++i) {
            const auto hit = scene_rays.intersect(rays[i]);
            REQUIRE(hit.has_value() == (hits[i].distance < kInfinity));
            if (hit) {
                CHECK(hit->at.triangle == hits[i].at.triangle);
                CHECK(hit->front == hits[i].front);
                CHECK(hit->distance == doctest::Approx(hits[i].distance).epsilon(1e-6));
                CHECK(length(position(surfaces, hit->at) - position(surfaces, hits[i].at)) < 1e-5f);
            }
            CHECK(passing[i] == scene_rays.visibility(rays[i]));
        }
    }
}

TEST_CASE(
    "a ray that starts on a surface, or on its coincident twin, meets neither, at any scale") {
    for (const float scale : {1e-3f, 1.0f, 1e3f})
        for (const float shift : {0.0f, 1.0f, 1000.0f}) {
            Scene scene = square(AlphaMode::opaque);
            Primitive twin = scene.meshes[0].primitives[0];
            for (uvec3& t : twin.triangles) std::swap(t.y, t.z);
            for (vec3& n : twin.normals) n = -n;
            scene.meshes[0].primitives.push_back(twin);
            scene.nodes[0].rotation = {0.2f, 0.3f, -0.1f, std::sqrt(1 - 0.14f)};
            scene.nodes[0].scale = {scale, scale, scale};
            scene.nodes[0].translation = {shift * scale, -2 * shift * scale, shift * scale};
            const Surfaces surfaces = pose(scene);
            const RayScene rays = *RayScene::create(scene, surfaces);
            Pcg32 random(3);
            for (int i = 0; i < 2000; ++i) {
                const float u = random.uniform(), v = random.uniform() * (1 - u);
                const SurfacePoint at{random.next() % 4, {u, v}};
                const vec3 n = geometric_normal(surfaces, at.triangle);
                const vec3 origin = offset_origin(position(surfaces, at), n,
                                                  coordinate_magnitude(surfaces, at.triangle));
                const float slope = random.uniform() * 6.28f;
                const vec3 grazing{std::cos(slope), std::sin(slope), 0.01f};
                const vec3 direction = normalize(Frame(n).to_world(grazing));
                CHECK(rays.visibility({origin, direction}) == 1);
            }
        }
}
