// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

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

namespace {

/// The top of the cube, 2 m wide at y = 1.
Scene cube_top() {
    Scene plane = cube();
    plane.meshes[0].primitives.erase(plane.meshes[0].primitives.begin());
    return plane;
}

/// A spike of 4 triangles, 3 m wide and 6 m high, somewhere.
SurfaceModel spike(int repeats) {
    SurfaceModel model;
    model.positions = {{4, 2, 4}, {7, 2, 4}, {7, 2, 7}, {4, 2, 7}, {5.5f, 8, 5.5f}};
    model.normals.assign(5, {0, 1, 0});
    model.triangles = {{1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}};
    model.repeats = repeats;
    return model;
}

/// The vertices that a model added, after those of the surface.
std::vector<vec3> tips(const Primitive& p, float above) {
    std::vector<vec3> found;
    for (const vec3 x : p.positions)
        if (x.y > above) found.push_back(x);
    return found;
}

}  // namespace

TEST_CASE("models stand on triangles as tall as they are wide, in the middle") {
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.level = 2;
    const size_t bare = triangle_count(refined(cube_top(), options));
    options.model = spike(1);
    const Scene scene = refined(cube_top(), options);
    const Primitive& p = scene.meshes[0].primitives[0];
    CHECK(p.triangles.size() == bare + 2 * 4);
    // Twice as tall as wide; as wide as the circle in an equilateral triangle of the mean edge.
    const float edge = (4 * 2 + std::sqrt(8.0f)) / 5, tall = 2 * edge / std::sqrt(3.0f);
    const std::vector<vec3> at = tips(p, 1.5f);
    REQUIRE(at.size() == 2);
    CHECK(at[0].y == doctest::Approx(1 + tall));
    // The middles of the two triangles are opposite each other, a third of the way.
    CHECK(length(at[0] + at[1] - vec3{0, 2 * (1 + tall), 0}) < 1e-5f);
    CHECK(std::fabs(at[0].x) == doctest::Approx(1 / 3.0f));
    CHECK(std::fabs(at[0].z) == doctest::Approx(1 / 3.0f));
    CHECK(p.positions.size() == p.texcoords[0].size());
    for (const vec3 n : p.normals) CHECK(n.y == doctest::Approx(1));
}

TEST_CASE("models repeat over quads, fill their cells and take the colour of the place") {
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.level = 1;
    options.control.quads = true;
    options.model = spike(3);
    const Scene scene = refined(cube_top(), options);
    const Primitive& p = scene.meshes[0].primitives[0];
    CHECK(p.triangles.size() == 8 + 9 * 4);
    const std::vector<vec3> at = tips(p, 1.5f);
    REQUIRE(at.size() == 9);
    for (const vec3 tip : at) {
        CHECK(tip.y == doctest::Approx(1 + 2 * 2 / 3.0f));
        // Middles of cells: multiples of 2/3.
        CHECK(std::fabs(1.5f * tip.x - std::round(1.5f * tip.x)) < 1e-5f);
        CHECK(std::fabs(1.5f * tip.z - std::round(1.5f * tip.z)) < 1e-5f);
    }
    Box box;
    for (size_t v = 0; v < p.positions.size(); ++v) {
        box.add(p.positions[v]);
        CHECK(p.texcoords[0][v].x == doctest::Approx(0.5f + 0.5f * p.positions[v].z));
        CHECK(p.texcoords[0][v].y == doctest::Approx(0.5f + 0.5f * p.positions[v].x));
    }
    CHECK(length(box.lo - vec3{-1, 1, -1}) < 1e-6f);
}

TEST_CASE("models go onto nothing that moves") {
    RefineOptions options;
    options.scheme = RefineScheme::pn;
    options.model = spike(1);
    Scene scene = cube_top();
    scene.meshes[0].primitives[0].targets.resize(1);
    const auto result = refine_scene(scene, options);
    REQUIRE(!result);
    CHECK(result.error().message.find("morph") != std::string::npos);
    options.scheme = RefineScheme::loop;
    CHECK(refine_scene(cube_top(), options).error().message.find("pn, st, phong") !=
          std::string::npos);
    options.scheme = RefineScheme::pn;
    options.field.emplace();
    CHECK(refine_scene(cube_top(), options).error().message.find("smooth surface") !=
          std::string::npos);
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
