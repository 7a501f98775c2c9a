// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/gather.h"

#include "aglow/core/parallel.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;

namespace {

constexpr int kSide = 16;  // texels along each face's edge

/// One face of a cube [-1, 1]^3 seen from inside, with its own square of the atlas.
void add_face(Primitive& p, int face, vec3 normal) {
    const Frame frame(normal);
    const auto base = static_cast<uint32_t>(p.positions.size());
    for (const vec2 corner : {vec2{-1, -1}, vec2{1, -1}, vec2{1, 1}, vec2{-1, 1}}) {
        p.positions.push_back(frame.to_world({corner.x, corner.y, -1}));
        p.normals.push_back(normal);
        p.lightmap_uvs.push_back(
            {(static_cast<float>(face) + 0.5f + 0.45f * corner.x) / 6, 0.5f + 0.45f * corner.y});
    }
    p.triangles.push_back({base, base + 1, base + 2});
    p.triangles.push_back({base, base + 2, base + 3});
}

struct Room {
    Scene scene;
    Atlas atlas;
    Surfaces surfaces;
    Texels texels;
};

/// A closed cube of edge 2 m, faces inward (or outward: then light meets backs only).
Room cube(float rho, float emission, float point_flux, bool inward = true) {
    Room room;
    Material material;
    material.base_color = {rho, rho, rho, 1};
    material.metallic = 0;
    material.emission = {emission, emission, emission};
    room.scene.materials.push_back(material);
    Primitive p;
    p.material = 0;
    int face = 0;
    for (const vec3 n : {vec3{1, 0, 0}, vec3{-1, 0, 0}, vec3{0, 1, 0}, vec3{0, -1, 0},
                         vec3{0, 0, 1}, vec3{0, 0, -1}})
        add_face(p, face++, n);
    if (!inward) {
        for (uvec3& t : p.triangles) std::swap(t.y, t.z);
        for (vec3& n : p.normals) n = -n;
    }
    room.scene.meshes.push_back({"cube", {p}, {}});
    Node node;
    node.mesh = 0;
    room.scene.nodes.push_back(node);
    if (point_flux > 0) add_point_light(room.scene, {0, 0, 0}, point_flux);
    room.atlas.width = 6 * kSide;
    room.atlas.height = kSide;
    room.atlas.placements.push_back({0, 0, 0, {6.0f * kSide, kSide}, {0, 0}});
    room.surfaces = pose(room.scene, -1, &room.atlas);
    room.texels = rasterize(room.surfaces, room.atlas, 4);
    return room;
}

struct Solved {
    GatherCache cache;
    IrradianceField field;
};

Solved solve(const Room& room, GatherOptions options, std::vector<Receiver> sensors = {}) {
    const RayScene rays = *RayScene::create(room.scene, room.surfaces);
    const Lights lights(room.scene, room.surfaces, world_transforms(room.scene));
    const World world{room.scene, room.surfaces, rays, lights};
    Solved result;
    result.cache = *solve_gather(world, room.texels, options);
    result.field = sensors.empty()
                       ? *gather_texels(world, room.texels, result.cache, options)
                       : *gather_receivers(world, room.texels, result.cache, sensors, options);
    return result;
}

vec3 mean(const Room& room, const IrradianceField& field, bool indirect) {
    vec3 sum{0, 0, 0};
    float area = 0;
    for (size_t e = 0; e < field.values.size(); ++e) {
        sum += (indirect ? field.values[e].indirect : field.values[e].direct) * room.texels.area[e];
        area += room.texels.area[e];
    }
    return sum / area;
}

}  // namespace

TEST_CASE("in a furnace every texel sees pi L / (1 - rho)") {
    for (const float rho : {0.2f, 0.5f, 0.8f}) {
        const Room room = cube(rho, 10, 0);
        const Solved solved = solve(room, {.min_samples = 256, .max_samples = 256});
        CAPTURE(rho);
        for (const Irradiance& value : solved.field.values)
            CHECK(value.total().x == doctest::Approx(10 * kPi / (1 - rho)).epsilon(0.03));
        CHECK((mean(room, solved.field, false) + mean(room, solved.field, true)).y ==
              doctest::Approx(10 * kPi / (1 - rho)).epsilon(0.002));
    }
}

TEST_CASE("a closed room's mean indirect light is that of the whole series of reflections") {
    const Room room = cube(0.5f, 0, 2400);
    const Solved solved = solve(room, {.min_samples = 64, .max_samples = 64});
    CHECK(mean(room, solved.field, false).x == doctest::Approx(100).epsilon(0.005));
    CHECK(mean(room, solved.field, true).x == doctest::Approx(100).epsilon(0.005));
}

TEST_CASE("a finite number of bounces takes exactly so many terms of the series") {
    for (const int bounces : {0, 1, 2, 5}) {
        const Room room = cube(0.5f, 0, 2400);
        const Solved solved =
            solve(room, {.bounces = bounces, .min_samples = 64, .max_samples = 64});
        CAPTURE(bounces);
        CHECK(mean(room, solved.field, true).x + 1 ==
              doctest::Approx(1 + 100 * (1 - std::pow(0.5, bounces))).epsilon(0.005));
    }
}

TEST_CASE("backs reflect like fronts: a room turned inside out is as bright to a sensor in it") {
    std::vector<Receiver> sensors(400, Receiver{{0.3f, -0.2f, 0.5f}, {0, 1, 0}, {0, 1, 0}, 0});
    for (const int bounces : {kConverged, 1, 3}) {
        GatherOptions options{.bounces = bounces, .min_samples = 256, .max_samples = 256};
        const auto inside = solve(cube(0.6f, 0, 2400), options, sensors);
        const auto outside = solve(cube(0.6f, 0, 2400, false), options, sensors);
        double sum_in = 0, sum_out = 0;
        for (size_t i = 0; i < sensors.size(); ++i) {
            sum_in += static_cast<double>(inside.field.values[i].indirect.x);
            sum_out += static_cast<double>(outside.field.values[i].indirect.x);
        }
        CAPTURE(bounces);
        CHECK(sum_out == doctest::Approx(sum_in).epsilon(0.01));
    }
}

TEST_CASE("the stated standard error covers the real error") {
    const Room room = cube(0.5f, 0, 2400);
    const Solved rough = solve(room, {.min_samples = 64, .max_samples = 64, .seed = 1});
    const Solved fine = solve(room, {.min_samples = 4096, .max_samples = 4096, .seed = 2});
    double within = 0;
    for (size_t e = 0; e < rough.field.values.size(); ++e) {
        const float error = std::abs(luminance(rough.field.values[e].total()) -
                                     luminance(fine.field.values[e].total()));
        within += error <= 3 * rough.field.standard_error[e] + 1e-3f;
    }
    CHECK(within / static_cast<double>(rough.field.values.size()) > 0.98);
}

TEST_CASE("light is the same to the bit for any number of threads and any run") {
    const Room room = cube(0.7f, 3, 500);
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return solve(room, {.cache_samples = 8, .min_samples = 32, .max_samples = 128}).field;
    };
    const IrradianceField one = run(1), two = run(2), again = run(2);
    for (size_t e = 0; e < one.values.size(); ++e) {
        CHECK(one.values[e].direct == two.values[e].direct);
        CHECK(one.values[e].indirect == two.values[e].indirect);
        CHECK(two.values[e].indirect == again.values[e].indirect);
    }
    CHECK(one.ray_count == two.ray_count);
}

TEST_CASE("a cancelled solve says so") {
    const Room room = cube(0.5f, 0, 100);
    const RayScene rays = *RayScene::create(room.scene, room.surfaces);
    const Lights lights(room.scene, room.surfaces, world_transforms(room.scene));
    const std::atomic<bool> cancel = true;
    const auto result =
        solve_gather({room.scene, room.surfaces, rays, lights}, room.texels, {}, {{}, &cancel});
    REQUIRE_FALSE(result);
    CHECK(result.error().code == Errc::cancelled);
}
