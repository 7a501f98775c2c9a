// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/displacement.h"

#include "aglow/core/file.h"
#include "aglow/core/image.h"
#include "aglow/refine/mesh_on_mesh.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/testing/patch_meshes.h"
#include "aglow/scene/image_file.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace aglow;
using namespace aglow::refine::testing;
using shared::Field;

namespace {

/// A square of `cells` x `cells` quads, or a share of them, in the plane z = 0, normals up, uv =
/// xy.
PatchMesh plane(uint32_t cells, float quads = 1) {
    PatchMesh mesh = random_sheet(1, cells, cells, quads);
    const float scale = 1 / static_cast<float>(cells);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto at = static_cast<uint32_t>(v);
        mesh.positions[v] = {static_cast<float>(at % (cells + 1)) * scale,
                             static_cast<float>(at / (cells + 1)) * scale, 0};
    }
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
        const vec3 p = mesh.positions[mesh.topology.vertex[h]];
        mesh.normals[h] = {0, 0, 1};
        mesh.uvs[h] = {p.x, p.y};
    }
    return mesh;
}

struct Displaced {
    std::vector<vec3> positions, normals;
};

Displaced displace(const PatchMesh& mesh, const DisplacementMap& displacement, int segments) {
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, segments));
    const Patches patches = demand(Patches::create(mesh.topology, {}));
    PatchControl control;
    patches.update(mesh.input(), control);
    Displaced result;
    result.positions.resize(t.vertex_count());
    result.normals.resize(t.vertex_count());
    patches.evaluate(control, t, displacement, result.positions, result.normals);
    return result;
}

TEST_CASE("the gradient of noise is that of its values") {
    Pcg32 random(2);
    for (int i = 0; i < 500; ++i) {
        const vec3 p = random_vector(random) * 7;
        const Field f = shared::fbm(p, 3, 2, 0.5f, 9);
        constexpr float kStep = 2e-3f;
        const auto slope = [&](vec3 d) {
            return (shared::fbm(p + d, 3, 2, 0.5f, 9).value -
                    shared::fbm(p - d, 3, 2, 0.5f, 9).value) /
                   (2 * kStep);
        };
        const vec3 expected = {slope({kStep, 0, 0}), slope({0, kStep, 0}), slope({0, 0, kStep})};
        CHECK(length(f.gradient - expected) < 2e-2f);
        CHECK(std::abs(f.value) < 2);
    }
}

TEST_CASE("noise is zero at the corners of its cells, continuous between, and has no mean") {
    Pcg32 random(3);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 cell = {std::round(8 * random.uniform()), std::round(8 * random.uniform()),
                           std::round(8 * random.uniform())};
        CHECK(shared::gradient_noise(cell, 5).value == 0);
        const vec3 on_face = {cell.x, 8 * random.uniform(), 8 * random.uniform()};
        const Field below = shared::gradient_noise(on_face - vec3{1e-5f, 0, 0}, 5);
        const Field above = shared::gradient_noise(on_face + vec3{1e-5f, 0, 0}, 5);
        CHECK(std::abs(below.value - above.value) < 1e-4f);
        CHECK(length(below.gradient - above.gradient) < 1e-2f);
        sum += double(shared::gradient_noise(random_vector(random) * 50, 5).value);
    }
    CHECK(std::abs(sum / 2000) < 0.03);
    CHECK(std::isfinite(shared::gradient_noise({1e30f, -1e30f, 0}, 5).value));
}

TEST_CASE("the fade of noise runs from 0 to 1, alike from both ends, with the slope that it says") {
    CHECK(shared::noise_fade(0) == 0);
    CHECK(shared::noise_fade(1) == 1);
    for (int i = 0; i <= 64; ++i) {
        const float t = static_cast<float>(i) / 64;
        CHECK(shared::noise_fade(t) + shared::noise_fade(1 - t) ==
              doctest::Approx(1).epsilon(1e-6));
        const double x = double(t);
        CHECK(double(shared::noise_fade(t)) ==
              doctest::Approx(6 * std::pow(x, 5) - 15 * std::pow(x, 4) + 10 * std::pow(x, 3)));
        CHECK(double(shared::noise_fade_slope(t)) ==
              doctest::Approx(30 * x * x * (x - 1) * (x - 1)).epsilon(1e-5));
    }
}

TEST_CASE("gradients of noise lie in a cube of edge 2, their components have nothing in common") {
    CHECK(shared::noise_component(0) == -1);
    CHECK(shared::noise_component(512) == 0);
    CHECK(shared::noise_component(1023) == 511.0f / 512);
    double xx = 0, xy = 0, yz = 0, zx = 0;
    constexpr int kCount = 4096;
    for (int i = 0; i < kCount; ++i) {
        const vec3 g = shared::noise_gradient(i, 3 * i, -i, 7);
        xx += double(g.x * g.x) / kCount;
        xy += double(g.x * g.y) / kCount;
        yz += double(g.y * g.z) / kCount;
        zx += double(g.z * g.x) / kCount;
    }
    CHECK(xx == doctest::Approx(1.0 / 3).epsilon(0.05));
    for (const double common : {xy, yz, zx}) CHECK(std::abs(common) < 0.03);  // six deviations
}

TEST_CASE("octaves are sums of other noise, as fine and as high as is said") {
    const vec3 p{0.3f, -1.7f, 2.6f};
    const Field first = shared::gradient_noise(p, 5), second = shared::gradient_noise(p * 3.0f, 6);
    const Field sum = shared::fbm(p, 2, 3, 0.25f, 5);
    CHECK(sum.value == doctest::Approx(first.value + 0.25f * second.value).epsilon(1e-6));
    CHECK(length(sum.gradient - first.gradient - second.gradient * 0.75f) < 1e-6f);
}

TEST_CASE("heights in space have the gradients that they say") {
    Pcg32 random(8);
    shared::Displacement d = {};
    d.amplitude = 0.7f;
    d.frequency = {2, 3, 0.5f};
    d.phase = 0.3f;
    d.octaves = 2;
    d.lacunarity = 2;
    d.gain = 0.5f;
    for (const uint32_t kind : {shared::kSineDisplacement, shared::kNoiseDisplacement}) {
        d.kind = kind;
        for (int i = 0; i < 200; ++i) {
            const vec3 p = random_vector(random) * 3.0f, way = normalize(random_vector(random));
            constexpr float kStep = 2e-3f;
            const float slope = (shared::displacement_at(d, p + way * kStep).value -
                                 shared::displacement_at(d, p - way * kStep).value) /
                                (2 * kStep);
            CHECK(std::abs(dot(shared::displacement_at(d, p).gradient, way) - slope) < 3e-3f);
        }
    }
}

TEST_CASE("a height's gradient counts along the surface alone, whatever its parameters") {
    Pcg32 random(9);
    for (int i = 0; i < 200; ++i) {
        const vec3 by_x = random_vector(random), by_y = random_vector(random);
        if (length(cross(by_x, by_y)) < 0.1f) continue;
        const vec3 n = normalize(cross(by_x, by_y)), slope = random_vector(random);
        const vec3 along = slope - n * dot(slope, n);
        // Of the height slope . P over the plane P = x by_x + y by_y.
        const vec3 g = shared::surface_gradient(by_x, by_y, dot(slope, by_x), dot(slope, by_y));
        CHECK(length(g - along) < 1e-4f);
        CHECK(length(shared::displaced_normal(n, slope) - normalize(n - along)) < 1e-6f);
    }
    CHECK(length(shared::surface_gradient({1, 0, 0}, {2, 0, 0}, 1, 1)) == 0);  // no surface
}

TEST_CASE("a plane displaced by a sine is the sine, and its normals are those of the sine") {
    const PatchMesh mesh = plane(2);
    DisplacementMap sine;
    sine.settings.kind = shared::kSineDisplacement;
    sine.settings.amplitude = 0.1f;
    sine.settings.frequency = {5, 3, 2};
    sine.settings.phase = 0.4f;
    const Displaced d = displace(mesh, sine, 9);
    for (size_t v = 0; v < d.positions.size(); ++v) {
        const vec3 p = d.positions[v];
        const float angle = 5 * p.x + 3 * p.y + 0.4f;
        CHECK(p.z == doctest::Approx(0.1f * std::sin(angle)).epsilon(1e-5));
        const vec3 n = normalize(vec3{-0.5f * std::cos(angle), -0.3f * std::cos(angle), 1});
        CHECK(length(d.normals[v] - n) < 1e-5f);
    }
}

TEST_CASE("a height map displaces by its heights, and tilts normals by its slopes") {
    // Waves of one period across the map, so that repeating it has no step.
    constexpr int kSize = 256;
    const auto turn = [](int i) { return 2 * kPi * (static_cast<float>(i) + 0.5f) / kSize; };
    std::vector<float> heights;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            heights.push_back(0.5f + 0.25f * std::sin(turn(x) + 1) + 0.25f * std::cos(turn(y) - 2));
    DisplacementMap map;
    map.map = make_height_map(heights, kSize, kSize);
    map.settings.kind = shared::kHeightMapDisplacement;
    map.settings.amplitude = 0.2f;
    map.settings.middle = 0.5f;
    map.settings.map = map.map.levels;
    for (const float quads : {0.0f, 1.0f}) {
        const PatchMesh mesh = plane(2, quads);
        map.uvs = mesh.uvs;
        const Displaced d = displace(mesh, map, 8);
        for (size_t v = 0; v < d.positions.size(); ++v) {
            const vec3 p = d.positions[v];
            const float a = 2 * kPi * p.x + 1, b = 2 * kPi * p.y - 2;
            CHECK(std::abs(p.z - 0.05f * (std::sin(a) + std::cos(b))) < 3e-5f);
            const vec3 n = normalize(vec3{-0.1f * kPi * std::cos(a), 0.1f * kPi * std::sin(b), 1});
            CHECK(length(d.normals[v] - n) < 3e-4f);
        }
    }
}

TEST_CASE("flat faces raised to a ball have the ball's normals, not those of both") {
    // One face of an octahedron. Along the ray of each point's direction the ball is so far off.
    PatchMesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.topology = topology_of({.face_begin = {0, 3}, .corners = {0, 1, 2}, .vertex_count = 3});
    mesh.normals = mesh.positions;
    mesh.uvs = {{0.1f, 0.1f}, {0.9f, 0.1f}, {0.1f, 0.9f}};
    constexpr int kSize = 256;
    std::vector<float> heights;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const vec2 at = {((static_cast<float>(x) + 0.5f) / kSize - 0.1f) / 0.8f,
                             ((static_cast<float>(y) + 0.5f) / kSize - 0.1f) / 0.8f};
            heights.push_back(1 - length(vec3{1 - at.x - at.y, at.x, at.y}));
        }
    DisplacementMap map;
    map.map = make_height_map(heights, kSize, kSize);
    map.settings.kind = shared::kHeightMapDisplacement;
    map.settings.amplitude = 1;
    map.settings.map = map.map.levels;
    map.uvs = mesh.uvs;
    const Patches patches =
        demand(Patches::create(mesh.topology, {PatchShape::flat, NormalField::linear}));
    PatchControl control;
    patches.update(mesh.input(), control);
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 12));
    std::vector<vec3> positions(t.vertex_count()), normals(t.vertex_count());
    patches.evaluate(control, t, map, positions, normals);
    for (size_t v = 0; v < positions.size(); ++v) {
        CHECK(std::abs(length(positions[v]) - 1) < 1e-4f);
        // Slopes are looked up as far as a texel from there, of which the face has 205.
        CHECK(length(normals[v] - normalize(positions[v])) < 1e-2f);
    }
}

TEST_CASE("levels of a height map are means, and levels between are between") {
    Pcg32 random(4);
    std::vector<float> heights(32 * 8);
    for (float& h : heights) h = random.uniform();
    const HeightMap map = make_height_map(heights, 32, 8);
    CHECK(map.levels.level_count == 6);
    double mean = 0;
    for (const float h : heights) mean += double(h) / double(heights.size());
    CHECK(double(map.texels.back()) == doctest::Approx(mean).epsilon(1e-5));
    CHECK(sample(map, {0.3f, 0.9f}, 9) == doctest::Approx(mean).epsilon(1e-5));
    for (int x = 0; x < 32; ++x) {
        const vec2 uv = {(static_cast<float>(x) + 0.5f) / 32, 3.5f / 8};
        CHECK(sample(map, uv, 0) == doctest::Approx(heights[static_cast<size_t>(3 * 32 + x)]));
        CHECK(sample(map, uv, 1.25f) ==
              doctest::Approx(0.75f * sample(map, uv, 1) + 0.25f * sample(map, uv, 2)));
    }
}

TEST_CASE("the fitting level has a texel for each segment") {
    const HeightMap map = make_height_map(std::vector<float>(256 * 256), 256, 256);
    const PatchMesh mesh = plane(2);  // edges are half the map: 128 texels
    CHECK(fitting_level(map, mesh.topology, mesh.uvs, 128) == doctest::Approx(0));
    CHECK(fitting_level(map, mesh.topology, mesh.uvs, 16) == doctest::Approx(3));
    CHECK(fitting_level(map, mesh.topology, mesh.uvs, 256) == 0);
}

TEST_CASE("height maps are read with 16 bits, as they are") {
    // 2 x 2 grey pixels 0, 1 / 32768, 65535.
    constexpr std::array<uint8_t, 75> kPng = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
        0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0x07,
        0x4d, 0x8e, 0xbb, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60,
        0x60, 0x60, 0x60, 0x64, 0x68, 0x60, 0xf8, 0xff, 0x1f, 0x00, 0x05, 0x0d, 0x02, 0x80, 0x01,
        0x70, 0xca, 0x8c, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    const testing::TemporaryFolder folder;
    const auto png = folder.path / "heights.PNG";
    REQUIRE(write_file(png, kPng));
    const HeightMap map = demand(read_height_map(png));
    CHECK(map.levels.width == 2);
    const std::array expected = {0.0f, 1.0f / 65535, 32768.0f / 65535, 1.0f};
    for (size_t i = 0; i < 4; ++i) CHECK(std::abs(map.texels[i] - expected[i]) < 2e-6f);

    Image image(3, 1);
    image.pixels = {{-2, 0, 0}, {0.125f, 0, 0}, {70000, 0, 0}};
    const auto exr = folder.path / "heights.exr";
    REQUIRE(write_image(image, exr));
    const HeightMap high = demand(read_height_map(exr));
    for (size_t i = 0; i < 3; ++i) CHECK(high.texels[i] == image.pixels[i].x);
    CHECK(!read_height_map(folder.path / "none.png"));
}

TEST_CASE("a relief of a plane is the plane, raised; cells meet") {
    PatchMesh mesh = random_sheet(6, 3, 3, 0.5f);
    for (vec3& p : mesh.positions) p.z = 0;
    mesh.normals.assign(mesh.normals.size(), {0, 0, 1});
    const Patches patches = demand(Patches::create(mesh.topology, {}));
    PatchControl control;
    patches.update(mesh.input(), control);
    const ReliefMesh triangle = {
        {{0, 0, 0.5f}, {1, 0, 0.5f}, {0, 1, 0.5f}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}};
    const ReliefMesh quad = {{{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}},
                             {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                             {{0, 1, 2}, {0, 2, 3}}};
    const RaisedMesh raised =
        raise_mesh(patches, control, triangle, quad, {.repeats = 3, .height = 0.2f});
    double area = 0, expected = 0;
    for (const vec3 p : raised.positions) CHECK(p.z == doctest::Approx(0.1f));
    for (const vec3 n : raised.normals) CHECK(length(n - vec3{0, 0, 1}) < 1e-5f);
    for (const uvec3 t : raised.triangles)
        area += 0.5 * double(cross(raised.positions[t.y] - raised.positions[t.x],
                                   raised.positions[t.z] - raised.positions[t.x])
                                 .z);
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f)
        for (uint32_t i = 2; i < mesh.topology.face_size(f); ++i) {
            const auto corner = [&](uint32_t k) {
                return mesh.positions[mesh.topology.vertex[mesh.topology.face_begin[f] + k]];
            };
            expected += 0.5 * double(cross(corner(i - 1) - corner(0), corner(i) - corner(0)).z);
        }
    CHECK(area == doctest::Approx(expected).epsilon(1e-5));
    CHECK(raised.face.size() == raised.positions.size());
    CHECK(raised.coordinates.size() == raised.positions.size());
}

}  // namespace
