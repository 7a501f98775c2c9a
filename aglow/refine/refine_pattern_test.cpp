// SPDX-License-Identifier: Apache-2.0
// Patterns that are not even.
#include "aglow/refine/refine_scene.h"

#include "aglow/refine/testing/scenes.h"

#include <doctest/doctest.h>

#include <array>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

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
