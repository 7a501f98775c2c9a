// SPDX-License-Identifier: Apache-2.0
// Models that are set on faces.
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace aglow;
using namespace aglow::refine::testing;

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
