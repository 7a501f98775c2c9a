// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/core/testing/scenes.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/load.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>

using namespace aglow;
namespace fs = std::filesystem;

namespace {

using Point = std::array<float, 3>;

Point point(vec3 p) { return {p.x, p.y, p.z}; }

/// A cube of two primitives, the top apart from the rest; every side has its own texture
/// coordinates and normals, as exporters write it.
Scene cube() {
    Scene scene;
    scene.name = "cube";
    Mesh mesh;
    mesh.primitives.resize(2);
    const auto add_side = [&](Primitive& p, vec3 n, vec3 u, vec3 v) {
        const auto first = static_cast<uint32_t>(p.positions.size());
        p.texcoords.resize(1);
        for (const vec2 at : {vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            p.positions.push_back(n + u * at.x + v * at.y);
            p.normals.push_back(n);
            p.texcoords[0].push_back({0.5f + 0.5f * at.x, 0.5f + 0.5f * at.y});
        }
        p.triangles.push_back({first, first + 1, first + 2});
        p.triangles.push_back({first, first + 2, first + 3});
    };
    const vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    add_side(mesh.primitives[0], x, y, z);
    add_side(mesh.primitives[0], x * -1.0f, z, y);
    add_side(mesh.primitives[0], y * -1.0f, x, z);
    add_side(mesh.primitives[0], z, x, y);
    add_side(mesh.primitives[0], z * -1.0f, y, x);
    add_side(mesh.primitives[1], y, z, x);
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

Scene refined(const Scene& scene, const RefineOptions& options) {
    auto result = refine_scene(scene, options);
    REQUIRE_MESSAGE(result, (result ? "" : to_string(result.error())));
    return std::move(*result);
}

Scene refined(const Scene& scene, RefineScheme scheme, int level) {
    RefineOptions options;
    options.scheme = scheme;
    options.level = level;
    return refined(scene, options);
}

size_t triangle_count(const Scene& scene) {
    size_t count = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) count += p.triangles.size();
    return count;
}

/// Edges of a posed scene, by the bits of their ends, that not exactly two triangles have.
size_t open_edges(const Surfaces& surfaces) {
    std::map<std::pair<Point, Point>, int> uses;
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const Point a = point(surfaces.corner(t, i)),
                        b = point(surfaces.corner(t, (i + 1) % 3));
            if (a != b) ++uses[std::minmax(a, b)];
        }
    return static_cast<size_t>(
        std::ranges::count_if(uses, [](const auto& use) { return use.second % 2 != 0; }));
}

const std::array kSchemes = {RefineScheme::loop, RefineScheme::catmull_clark, RefineScheme::pn,
                             RefineScheme::tagged, RefineScheme::phong};

}  // namespace

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

TEST_CASE("a constant height moves every vertex by it, and no crack opens") {
    RefineOptions options;
    options.level = 2;
    const std::array heights = {0.5f, 0.5f, 0.5f, 0.5f};
    options.displacement = HeightDisplacement{make_height_map(heights, 2, 2), 0.2f, 0.05f};
    const Surfaces moved = pose(refined(cube(), options));
    options.displacement.reset();
    const Surfaces still = pose(refined(cube(), options));
    for (size_t v = 0; v < moved.positions.size(); ++v)
        CHECK(length(moved.positions[v] - still.positions[v]) ==
              doctest::Approx(0.15).epsilon(1e-4));
    CHECK(open_edges(moved) == 0);
}

TEST_CASE("texels of a height map are taken as coarse as the refined vertices are apart") {
    constexpr int kSize = 64, kLevel = 3, kSpan = kSize >> kLevel;  // texels between vertices
    std::vector<float> heights;
    for (int i = 0; i < kSize * kSize; ++i)
        heights.push_back(static_cast<float>(i * 7919 % 4093) / 4093);
    Scene scene;
    scene.meshes.resize(1);
    Primitive& p = scene.meshes[0].primitives.emplace_back();
    p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    p.normals.assign(4, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    scene.nodes.emplace_back().mesh = 0;
    RefineOptions options;
    options.scheme = RefineScheme::flat;
    options.level = kLevel;
    options.displacement = HeightDisplacement{make_height_map(heights, kSize, kSize), 0.5f, 0.25f};
    const Primitive fine = refined(scene, options).meshes[0].primitives[0];
    CHECK(fine.positions.size() == 81);
    for (const vec3 at : fine.positions) {
        // Between four texels of the level: the mean of all that these are made of.
        const int x = static_cast<int>(std::lround(at.x * kSize)),
                  y = static_cast<int>(std::lround(at.y * kSize));
        double sum = 0;
        for (int j = y - kSpan; j < y + kSpan; ++j)
            for (int i = x - kSpan; i < x + kSpan; ++i)
                sum += double{heights[static_cast<size_t>((j + kSize) % kSize * kSize +
                                                          (i + kSize) % kSize)]};
        CHECK(double{at.z} ==
              doctest::Approx(0.25 + 0.5 * sum / (4 * kSpan * kSpan)).epsilon(1e-5));
    }
}

TEST_CASE("sides that meet at two degrees keep their normals where they are to part") {
    Scene scene;
    scene.meshes.resize(1);
    Primitive& p = scene.meshes[0].primitives.emplace_back();
    const float c = std::cos(2 * kPi / 180), s = std::sin(2 * kPi / 180);
    p.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, s}, {c, 1, s}};
    p.normals.assign(6, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    p.texcoords = {std::vector<vec2>(6, vec2{0, 0})};
    scene.nodes.emplace_back().mesh = 0;
    RefineOptions options;
    options.level = 2;
    options.control.crease_angle = 1 * kPi / 180;
    const HeightMap flat = make_height_map(std::array{1.0f}, 1, 1);
    for (const RefineScheme scheme : kSchemes)
        for (const bool displaced : {false, true}) {
            CAPTURE(static_cast<int>(scheme));
            CAPTURE(displaced);
            options.scheme = scheme;
            options.displacement.reset();
            if (displaced) options.displacement = HeightDisplacement{flat, 0, 0};
            const Primitive fine = refined(scene, options).meshes[0].primitives[0];
            for (const uvec3 t : fine.triangles)
                for (const uint32_t v : {t.x, t.y, t.z}) {
                    const vec3 middle =
                        fine.positions[t.x] + fine.positions[t.y] + fine.positions[t.z];
                    const vec3 side = middle.x < 0 ? vec3{0, 0, 1} : vec3{-s, 0, c};
                    CHECK(length(fine.normals[v] - side) < 1e-4f);
                }
        }
}

TEST_CASE("normals of displaced triangles count by their angles") {
    // A cube whose corners have four to six triangles, smooth at its corners.
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives)
        for (size_t v = 0; v < p.positions.size(); ++v) p.normals[v] = normalize(p.positions[v]);
    RefineOptions options;
    options.scheme = RefineScheme::flat;
    options.level = 1;
    options.displacement = HeightDisplacement{make_height_map(std::array{1.0f}, 1, 1), 0, 0};
    size_t corners = 0;
    const Scene fine = refined(scene, options);
    for (const Primitive& p : fine.meshes[0].primitives)
        for (size_t v = 0; v < p.positions.size(); ++v) {
            if (length(p.positions[v]) < 1.7f) continue;
            CHECK(length(p.normals[v] - normalize(p.positions[v])) < 1e-5f);
            ++corners;
        }
    CHECK(corners >= 8);
}

TEST_CASE("a height map that differs across seams does not open them") {
    RefineOptions options;
    options.level = 3;
    std::vector<float> heights;
    for (int i = 0; i < 64; ++i) heights.push_back(static_cast<float>(i * 37 % 64) / 64);
    options.displacement = HeightDisplacement{make_height_map(heights, 8, 8), 0.1f, 0};
    for (const RefineScheme scheme : kSchemes) {
        options.scheme = scheme;
        CHECK(open_edges(pose(refined(cube(), options))) == 0);
    }
}

TEST_CASE("a sine of place moves a plane as the sine says, and noise as the field says") {
    const vec3 wave{3, 0, -5};
    shared::Displacement sine{};
    sine.kind = shared::kSineDisplacement;
    sine.amplitude = 0.05f;
    sine.frequency = wave;
    shared::Displacement noise{};
    noise.kind = shared::kNoiseDisplacement;
    noise.amplitude = 0.1f;
    noise.frequency = {2, 2, 2};
    noise.octaves = 4;
    noise.lacunarity = 2;
    noise.gain = 0.5f;
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());  // the top alone: y = 1
    for (const RefineScheme scheme : kSchemes) {
        RefineOptions options;
        options.scheme = scheme;
        options.level = 5;
        options.field = sine;
        const Scene waves = refined(plane, options);
        for (const vec3 p : waves.meshes[0].primitives[0].positions)
            CHECK(double(p.y) ==
                  doctest::Approx(1 + 0.05 * std::sin(double(dot(wave, {p.x, 1, p.z})))));
        options.field = noise;
        const Scene rough = refined(plane, options);
        for (const vec3 p : rough.meshes[0].primitives[0].positions) {
            const float height = shared::fbm(vec3{p.x, 1, p.z} * 2, 4, 2, 0.5f, 0).value;
            CHECK(p.y == doctest::Approx(1 + 0.1f * height).epsilon(1e-5));
        }
        CHECK(open_edges(pose(refined(cube(), options))) == 0);
    }
}

TEST_CASE("a sine's normals are those of its slope") {
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());
    RefineOptions options;
    options.level = 7;
    options.field = shared::Displacement{};
    options.field->kind = shared::kSineDisplacement;
    options.field->amplitude = 0.1f;
    options.field->frequency = {4, 0, 0};
    const Scene fine = refined(plane, options);
    const Primitive& top = fine.meshes[0].primitives[0];
    for (size_t v = 0; v < top.positions.size(); ++v) {
        const vec3 p = top.positions[v];
        if (std::max(std::fabs(p.x), std::fabs(p.z)) > 0.99f) continue;  // one-sided at the rim
        const vec3 expected = normalize(vec3{-0.4f * std::cos(4 * p.x), 1, 0});
        CHECK(length(top.normals[v] - expected) < 2e-3f);
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

namespace {

/// A convex drum: flat in the middle of its ends, bent where they meet the side.
Scene drum() {
    constexpr uint32_t kSides = 12;
    Scene scene;
    Primitive p;
    const auto add = [&](float radius, float height, vec2 normal, uint32_t sides) {
        for (uint32_t side = 0; side < sides; ++side) {
            const float a = 2 * kPi * static_cast<float>(side) / kSides;
            p.positions.push_back({radius * std::cos(a), height, -radius * std::sin(a)});
            p.normals.push_back(
                normalize(vec3{normal.x * std::cos(a), normal.y, -normal.x * std::sin(a)}));
            p.colors.push_back({0.5f + height, 0.5f, 0, 1});
        }
    };
    add(0, 0.5f, {0, 1}, 1);
    add(0.8f, 0.4f, {1, 1}, kSides);
    add(0.8f, -0.4f, {1, -1}, kSides);
    add(0, -0.5f, {0, -1}, 1);
    for (uint32_t side = 0; side < kSides; ++side) {
        const uint32_t a = 1 + side, b = 1 + (side + 1) % kSides;
        const uint32_t c = a + kSides, d = b + kSides;
        p.triangles.push_back({0, a, b});
        p.triangles.push_back({a, c, d});
        p.triangles.push_back({a, d, b});
        p.triangles.push_back({c, 1 + 2 * kSides, d});
    }
    scene.meshes.push_back({"drum", {std::move(p)}, {}});
    scene.nodes.emplace_back().mesh = 0;
    return scene;
}

double volume(const Scene& scene) {
    double sum = 0;
    const Surfaces surfaces = pose(scene);
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t)
        sum += double(dot(surfaces.corner(t, 0),
                          cross(surfaces.corner(t, 1), surfaces.corner(t, 2)))) /
               6;
    return sum;
}

const std::array kPatchSchemes = {RefineScheme::pn, RefineScheme::tagged, RefineScheme::phong};

}  // namespace

TEST_CASE("irregular patterns have the same triangles on the same surface, more of it caught") {
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.level = 2;
    const Scene even = refined(drum(), options);
    options.pattern.irregular = true;
    const Scene irregular = refined(drum(), options);
    options.level = 7;
    options.pattern = {};
    const double smooth = volume(refined(drum(), options));
    CHECK(triangle_count(irregular) == triangle_count(even));
    // Inscribed in what bulges everywhere: what is missing is the error.
    const double error = smooth - volume(irregular), even_error = smooth - volume(even);
    CHECK(error > 0);
    CHECK(error < 0.9 * even_error);
    CHECK(open_edges(pose(irregular)) == 0);
}

TEST_CASE("an eye draws the vertices of each triangle towards it") {
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());
    plane.nodes[0].translation = {5, 0, 0};
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.level = 3;
    options.pattern.irregular = true;
    for (const float side : {0.0f, 1.0f, -1.0f}) {
        if (side != 0) options.pattern.eye = vec3{5 + 1.5f * side, 2, 0};
        const Scene fine = refined(plane, options);
        const auto& positions = fine.meshes[0].primitives[0].positions;
        vec3 mean{0, 0, 0};
        for (const vec3 p : positions) mean += p / static_cast<float>(positions.size());
        CHECK(mean.x * side >= 0.02f * std::fabs(side));
        CHECK(std::fabs(mean.x) <= 0.2f * std::fabs(side) + 1e-6f);
        CHECK(std::fabs(mean.z) < 0.05f);  // the diagonal is not symmetric
        CHECK(mean.y == doctest::Approx(1));
    }
}

TEST_CASE("a tolerance takes the triangles that it needs and is kept") {
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.level = 7;
    const double smooth = volume(refined(drum(), options));
    size_t last = 0;
    for (const float tolerance : {0.02f, 0.005f, 0.001f}) {
        options.pattern.tolerance = tolerance;
        const Scene fine = refined(drum(), options);
        // The surface is about 10 m^2 large.
        CHECK(std::fabs(smooth - volume(fine)) < 10 * double(tolerance));
        CHECK(triangle_count(fine) > last);
        CHECK(triangle_count(fine) < 48 * 16384 / 16);
        CHECK(open_edges(pose(fine)) == 0);
        last = triangle_count(fine);
    }
    // Edges that are straight stay as they are.
    options.pattern.tolerance = 1e-4f;
    CHECK(triangle_count(refined(cube(), options)) == 12);
}

TEST_CASE("irregular and adaptive patterns meet bitwise and carry attributes along") {
    for (const RefineScheme scheme : kPatchSchemes) {
        RefineOptions options;
        options.scheme = scheme;
        options.level = 3;
        options.pattern.irregular = true;
        options.control.crease_angle = 2.0f;  // smooth normals
        for (const bool adaptive : {false, true}) {
            if (adaptive) options.pattern.tolerance = 0.01f;
            CHECK(open_edges(pose(refined(cube(), options))) == 0);
        }
        options.scheme = RefineScheme::pn;
        options.control = {};
        const Scene flat = refined(cube(), options);  // by its flat normals it stays a cube
        for (const Primitive& p : flat.meshes[0].primitives)
            for (size_t v = 0; v < p.positions.size(); ++v)
                if (p.normals[v].y > 0.9f) {  // u along z, v along x on the top
                    CHECK(p.texcoords[0][v].x ==
                          doctest::Approx(0.5f + 0.5f * p.positions[v].z).epsilon(1e-5));
                }
    }
    // Colours are linear over the coarse triangle, as heights are where its edges are straight.
    RefineOptions options;
    options.scheme = RefineScheme::flat;
    options.level = 3;
    options.pattern.irregular = true;
    options.pattern.eye = vec3{0, 3, 0};
    const Scene fine = refined(drum(), options);
    const Primitive& p = fine.meshes[0].primitives[0];
    for (size_t v = 0; v < p.positions.size(); ++v)
        CHECK(p.colors[v].x == doctest::Approx(0.5f + p.positions[v].y).epsilon(1e-5));
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

TEST_CASE("of the joints between two vertices the heaviest stay, as many as the file has") {
    // Two triangles side by side; joints of the vertices on the left and on the right differ.
    for (const size_t width : {4u, 8u, 12u}) {
        CAPTURE(width);
        Scene scene;
        scene.meshes.resize(1);
        Primitive& p = scene.meshes[0].primitives.emplace_back();
        p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        p.normals.assign(4, {0, 0, 1});
        p.triangles = {{0, 1, 2}, {0, 2, 3}};
        p.influences = static_cast<int>(width);
        std::map<uint32_t, double> left, right;
        for (const vec3 x : p.positions)
            for (uint32_t i = 0; i < width; ++i) {
                const auto count = static_cast<uint32_t>(width);
                const uint32_t joint = x.x == 0 ? i : count / 2 + i;
                const float rank = x.x == 0 ? float(i) + 1 : float(count - i) + 0.5f;
                const float all = 0.5f * float(count) * (float(count) + (x.x == 0 ? 1.0f : 2.0f));
                p.joints.push_back(joint);
                p.weights.push_back(rank / all);
                (x.x == 0 ? left : right)[joint] = double{p.weights.back()};
            }
        scene.nodes.emplace_back().mesh = 0;
        const Primitive fine = refined(scene, RefineScheme::phong, 1).meshes[0].primitives[0];
        const size_t kept = width == 4 ? 4 : 8;
        REQUIRE(fine.influences == static_cast<int>(kept));
        for (size_t v = 0; v < fine.positions.size(); ++v) {
            const auto share = double{fine.positions[v].x};  // linear from left to right
            std::map<uint32_t, double> mean;
            for (const auto& [joint, weight] : left) mean[joint] += (1 - share) * weight;
            for (const auto& [joint, weight] : right) mean[joint] += share * weight;
            std::vector<std::pair<double, uint32_t>> heaviest;
            for (const auto& [joint, weight] : mean)
                if (weight > 0) heaviest.emplace_back(weight, joint);
            std::ranges::sort(heaviest, std::greater());
            heaviest.resize(std::min(heaviest.size(), kept));
            double sum = 0;
            for (const auto& [weight, joint] : heaviest) sum += weight;
            for (size_t i = 0; i < heaviest.size(); ++i) {
                CHECK(fine.joints[v * kept + i] == heaviest[i].second);
                CHECK(fine.weights[v * kept + i] ==
                      doctest::Approx(heaviest[i].first / sum).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("of joints that weigh the same the first ones stay") {
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives) {
        p.influences = 8;
        for (uint32_t v = 0; v < p.positions.size(); ++v)
            for (uint32_t i = 0; i < 8; ++i) {
                p.joints.push_back(i);
                p.weights.push_back(0.125f);
            }
    }
    const Scene fine = refined(scene, RefineScheme::phong, 1);
    for (const Primitive& p : fine.meshes[0].primitives)
        for (size_t i = 0; i < p.joints.size(); ++i) {
            CHECK(p.joints[i] == i % 8);
            CHECK(p.weights[i] == doctest::Approx(0.125).epsilon(1e-6));
        }
}

TEST_CASE("skinned models: refined then posed is close to posed then refined, and closed") {
    for (const char* name : {"CesiumMan/CesiumMan.glb", "Fox/Fox.glb"}) {
        const fs::path path = scenes_folder() / "khronos" / name;
        if (!is_here(path)) return;
        CAPTURE(name);
        const auto scene = load_scene(path);
        REQUIRE(scene);
        const Scene fine = refined(*scene, RefineScheme::loop, 1);
        for (const Primitive& p : fine.meshes[0].primitives)
            for (size_t v = 0; v < p.positions.size(); ++v) {
                float sum = 0;
                for (size_t i = 0; i < 4; ++i) sum += p.weights[4 * v + i];
                CHECK(sum == doctest::Approx(1).epsilon(1e-6));
            }
        // Boundaries of the model stay; refining puts one vertex on each of their edges.
        const size_t boundary = open_edges(pose(*scene));
        for (const double time : {0.0, 0.4, 1.1}) {
            const Surfaces posed = pose(fine, time);
            CHECK(open_edges(posed) == 2 * boundary);
            // The coarse model, posed and frozen into a scene of its own.
            Scene frozen;
            const Surfaces coarse = pose(*scene, time);
            Mesh mesh;
            mesh.primitives.resize(1);
            mesh.primitives[0].positions = coarse.positions;
            mesh.primitives[0].normals = coarse.normals;
            mesh.primitives[0].texcoords = coarse.texcoords;
            mesh.primitives[0].triangles = coarse.triangles;
            frozen.meshes.push_back(std::move(mesh));
            frozen.nodes.emplace_back().mesh = 0;
            const Surfaces direct = pose(refined(frozen, RefineScheme::loop, 1));
            REQUIRE(direct.triangles.size() == posed.triangles.size());
            Box box;
            for (const vec3 p : direct.positions) box.add(p);
            double sum = 0;
            for (uint32_t t = 0; t < direct.triangles.size(); ++t)
                for (int i = 0; i < 3; ++i)
                    sum += static_cast<double>(length(direct.corner(t, i) - posed.corner(t, i)));
            const double mean = sum / (3.0 * static_cast<double>(direct.triangles.size()));
            CHECK(mean < 0.006 * static_cast<double>(length(box.hi - box.lo)));
        }
    }
}
