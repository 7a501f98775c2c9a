// SPDX-License-Identifier: Apache-2.0
// The formulas of patches one by one, where whole patches would hide a small error.
#include "aglow/core/math.h"
#include "aglow/core/random.h"
#include "aglow/refine/testing/patch_meshes.h"
#include "aglow/shared/pattern.h"
#include "aglow/shared/pn_quad.h"
#include "aglow/shared/tagged_triangle.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

vec3 random_unit(Pcg32& random) { return normalize(vec3{0, 0, 2} + random_vector(random)); }

}  // namespace

TEST_CASE("an edge is smooth below 5 degrees, a crease above 20, and between as its cosine says") {
    const auto cosine = [](float degrees) { return std::cos(degrees * kPi / 180); };
    for (const float degrees :
         {0.0f, 2.0f, 4.9f, 6.0f, 10.0f, 15.0f, 19.0f, 21.0f, 60.0f, 120.0f}) {
        CAPTURE(degrees);
        // Both normals lean to the sides of y: it lies in both tangent planes.
        const float lean = 0.5f * degrees * kPi / 180;
        const vec3 left{std::sin(lean), 0, std::cos(lean)}, right{-left.x, 0, left.z};
        const vec3 t = shared::edge_tangent({1, 2, 3}, left, right);
        const float crease =
            std::clamp((cosine(5) - cosine(degrees)) / (cosine(5) - cosine(20)), 0.0f, 1.0f);
        CHECK(t.x == doctest::Approx(1 - crease).epsilon(5e-4));
        CHECK(t.y == doctest::Approx(2).epsilon(1e-5));
        CHECK(std::abs(t.z) < 1e-5f);
    }
}

TEST_CASE(
    "a quad's normals are those of its edges on them, and bilinear where its edges' are linear") {
    Pcg32 random(31);
    for (int i = 0; i < 100; ++i) {
        shared::QuadNormals c;
        for (vec3& n : c.n) n = random_unit(random);
        const float t = random.uniform();
        const vec2 on_edge[] = {{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}};
        for (size_t e = 0; e < 4; ++e) {
            const vec3 expected = shared::edge_normal(c.n[e], c.n[4 + e], c.n[(e + 1) % 4], t);
            CHECK(length(shared::quad_normal(c, on_edge[e].x, on_edge[e].y) - expected) < 1e-5f);
        }
        for (size_t e = 0; e < 4; ++e) c.n[4 + e] = shared::linear_middle(c.n[e], c.n[(e + 1) % 4]);
        const float x = random.uniform(), y = random.uniform();
        const vec3 bilinear =
            (c.n[0] * (1 - x) + c.n[1] * x) * (1 - y) + (c.n[3] * (1 - x) + c.n[2] * x) * y;
        CHECK(length(shared::quad_normal(c, x, y) - normalize(bilinear)) < 1e-5f);
    }
}

TEST_CASE("derivatives of patches are their slopes") {
    Pcg32 random(32);
    constexpr float kStep = 1.0f / 64;  // differences of cubics across it are off by its square
    for (int i = 0; i < 100; ++i) {
        shared::PatchPoints triangle;
        for (vec3& p : triangle.p) p = random_vector(random);
        shared::QuadPoints quad;
        for (vec3& p : quad.p) p = random_vector(random);
        const float x = 0.1f + 0.4f * random.uniform(), y = 0.1f + 0.4f * random.uniform();
        // Richardson: of cubics the differences over one and two steps give the slope exactly.
        const auto slope = [&](const auto& at) {
            const vec3 one = (at(kStep) - at(-kStep)) / (2 * kStep);
            const vec3 two = (at(2 * kStep) - at(-2 * kStep)) / (4 * kStep);
            return (one * 4.0f - two) / 3.0f;
        };
        const auto on_triangle = [&](float dx, float dy) {
            return shared::patch_position(triangle, 1 - x - dx - y - dy, x + dx, y + dy);
        };
        const auto on_quad = [&](float dx, float dy) {
            return shared::quad_position(quad, x + dx, y + dy);
        };
        const float u = 1 - x - y;
        CHECK(length(shared::patch_derivative_v(triangle, u, x, y) -
                     slope([&](float d) { return on_triangle(d, 0); })) < 1e-4f);
        CHECK(length(shared::patch_derivative_w(triangle, u, x, y) -
                     slope([&](float d) { return on_triangle(0, d); })) < 1e-4f);
        CHECK(length(shared::quad_derivative_x(quad, x, y) -
                     slope([&](float d) { return on_quad(d, 0); })) < 1e-4f);
        CHECK(length(shared::quad_derivative_y(quad, x, y) -
                     slope([&](float d) { return on_quad(0, d); })) < 1e-4f);
    }
}

TEST_CASE("tags stay within their bounds, and sharpness turns a corner's normal to its face's") {
    const shared::ShapeTags high = shared::bounded_tags({2, 3, 4});
    CHECK(high.sharpness == 1);
    CHECK(high.tension == 1);
    CHECK(high.bias == 1);
    const shared::ShapeTags low = shared::bounded_tags({-2, -3, -4});
    CHECK(low.sharpness == 0);
    CHECK(low.tension == -1);
    CHECK(low.bias == -1);
    Pcg32 random(33);
    const vec3 n = random_unit(random), face = random_unit(random);
    for (const float s : {0.0f, 0.25f, 0.5f, 1.0f})
        CHECK(length(shared::tagged_normal(n, face, s) - normalize(n * (1 - s) + face * s)) <
              1e-6f);
}

TEST_CASE("densities draw points by the projective map that has them as its weights") {
    Pcg32 random(34);
    for (int i = 0; i < 100; ++i) {
        const auto density = [&] { return 0.2f + 3 * random.uniform(); };
        const vec3 d{density(), density(), density()};
        const float t = random.uniform(), x = 0.5f * random.uniform(), y = 0.5f * random.uniform();
        CHECK(shared::dense_parameter(t, d.x, d.y) ==
              doctest::Approx(t * d.y / ((1 - t) * d.x + t * d.y)).epsilon(1e-5));
        const vec2 inside = shared::dense_coordinates({x, y}, d);
        const float sum = (1 - x - y) * d.x + x * d.y + y * d.z;
        CHECK(inside.x == doctest::Approx(x * d.y / sum).epsilon(1e-5));
        CHECK(inside.y == doctest::Approx(y * d.z / sum).epsilon(1e-5));
        // Edges have the same points from both sides.
        CHECK(shared::dense_coordinates({t, 0}, d).x ==
              doctest::Approx(shared::dense_parameter(t, d.x, d.y)).epsilon(1e-5));
        CHECK(shared::dense_coordinates({0, t}, d).y ==
              doctest::Approx(shared::dense_parameter(t, d.x, d.z)).epsilon(1e-5));
    }
}
