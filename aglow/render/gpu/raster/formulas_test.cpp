// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/half.h"
#include "aglow/render/gpu/raster/light.h"
#include "aglow/render/gpu/raster/part_list.h"
#include "aglow/render/testing/stage.h"
#include "aglow/shared/form_factor.h"

#include <rapidcheck.h>

#include <cmath>

using namespace aglow;
using namespace aglow::render;
using namespace aglow::render::gpu;
using namespace aglow::render::testing;

TEST_CASE("the form factor of a triangle is that of its solid angle, where it is small and far") {
    // Seen straight on: A / (pi d^2).
    const shared::Triangle ahead{{0, 0, 10}, {0, 0.1f, 10}, {0.1f, 0, 10}};  // faces down
    const float small = shared::signed_form_factor({0, 0, 0}, {0, 0, 1}, ahead);
    CHECK(small == doctest::Approx(0.005 / (kPi * 100)).epsilon(0.01));
    const shared::Triangle turned{ahead.a, ahead.c, ahead.b};
    CHECK(shared::signed_form_factor({0, 0, 0}, {0, 0, 1}, turned) == doctest::Approx(-small));
    CHECK(shared::signed_form_factor({0, 0, 0}, {0, 0, -1}, ahead) == 0);
}

TEST_CASE("triangles that fill the hemisphere have form factors that add up to 1") {
    const float far = 1000;
    const vec3 ring[4] = {{far, 0, -1}, {0, far, -1}, {-far, 0, -1}, {0, -far, -1}};
    float sum = 0;
    for (int i = 0; i < 4; ++i)  // a pyramid whose inside is its front
        sum += shared::signed_form_factor({0, 0, 0}, {0, 0, 1},
                                          {ring[i], {0, 0, 2}, ring[(i + 1) % 4]});
    CHECK(sum == doctest::Approx(1).epsilon(0.001));
}

TEST_CASE("irradiance of an even sky is pi L whatever the normal") {
    Scene scene;
    scene.sky = Sky{{3, 2, 1}, nullptr};
    shared::RasterFrame frame{};
    const auto terms = sky_terms(scene);
    std::copy(terms.begin(), terms.end(), frame.sky);
    for (const vec3 n : {vec3{1, 0, 0}, vec3{0, -1, 0}, vec3{0.6f, 0, 0.8f}}) {
        const vec3 e = shared::sky_irradiance(frame, n);
        CHECK(e.x == doctest::Approx(3 * kPi).epsilon(1e-3));
        CHECK(e.z == doctest::Approx(kPi).epsilon(1e-3));
    }
}

TEST_CASE("16-bit floats are what IEEE 754 says") {
    CHECK(half_to_float(0x3c00) == 1);
    CHECK(half_to_float(0xc000) == -2);
    CHECK(half_to_float(0x7bff) == 65504);
    CHECK(half_to_float(0x0001) == std::ldexp(1.0f, -24));
    CHECK(half_to_float(0x3555) == doctest::Approx(1.0 / 3).epsilon(1e-3));
    CHECK(std::isinf(half_to_float(0x7c00)));
    CHECK(std::isnan(half_to_float(0x7e00)));
}

namespace {

View looking_down(bool perspective) {
    View view = from_above(5, 1, 10);
    view.perspective = perspective;
    return view;
}

float between(float lo, float hi, uint32_t random) {
    return lo + (hi - lo) * static_cast<float>(random % 1024) / 1023;
}

}  // namespace

TEST_CASE("no box is left out of which a point can be seen") {
    CHECK(rc::check([](uint32_t x, uint32_t y, uint32_t z, uint32_t size, bool perspective) {
        const vec3 lo{between(-8, 8, x), between(-8, 8, y), between(-8, 8, z)};
        const vec3 hi = lo + vec3{1, 1, 1} * between(0.01f, 4, size);
        const Projection projection =
            projection_of(looking_down(perspective), {{-8, -8, -8}, {8, 8, 8}});
        bool seen = false;
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= 4; ++j)
                for (int k = 0; k <= 4; ++k) {
                    const vec3 t{static_cast<float>(i) / 4, static_cast<float>(j) / 4,
                                 static_cast<float>(k) / 4};
                    const vec4 p = projection.clip(lo + (hi - lo) * t);
                    seen |=
                        std::fabs(p.x) <= p.w && std::fabs(p.y) <= p.w && p.z >= 0 && p.z <= p.w;
                }
        RC_ASSERT(!seen || projection.may_see({lo, hi}));
    }));
}

TEST_CASE("depth is 1 near the camera and falls with distance") {
    for (const bool perspective : {false, true}) {
        const Projection projection =
            projection_of(looking_down(perspective), {{-1, -1, -1}, {1, 1, 1}});
        float before = 1.0001f;
        for (const float z : {4.99f, 4.0f, 1.0f, -1.0f, -10.0f}) {
            const vec4 p = projection.clip({0, 0, z});
            CHECK(p.z / p.w < before);
            CHECK(p.z / p.w > 0);
            before = p.z / p.w;
        }
    }
}

TEST_CASE("parts out of sight are left out, and neighbours drawn together") {
    Quads quads;
    for (const float at : {-20.0f, -0.5f, 0.0f, 0.5f, 20.0f})
        quads.add(diffuse({1, 1, 1}), {at, 0, 0}, {at + 0.1f, 0, 0}, {at + 0.1f, 0.1f, 0},
                  {at, 0.1f, 0});
    const Surfaces rest = pose(quads.scene);
    const PartList parts(quads.scene, rest);
    const std::vector<mat4> transforms(5);
    const Projection projection = projection_of(looking_down(false), parts.bounds(transforms));
    const auto layers = parts.visible(transforms, projection, 0);
    CHECK(layers[static_cast<size_t>(Layer::opaque)] == std::vector<FaceRange>{{2, 6}});
    CHECK(layers[static_cast<size_t>(Layer::cut)].empty());
    CHECK(parts.has(Layer::opaque));
    CHECK_FALSE(parts.has(Layer::blended));
}

TEST_CASE("a part that its mesh's others may pull into sight is drawn") {
    Quads quads;
    quads.floor(diffuse({1, 1, 1}), 0.1f);
    aglow::testing::add_quad(quads.scene.meshes[0].primitives.emplace_back(), {20, 0, 0},
                             {21, 0, 0}, {21, 1, 0}, {20, 1, 0});
    const Surfaces rest = pose(quads.scene);
    const std::vector<mat4> transforms(2);
    for (const Reach reach : {Reach::part, Reach::mesh}) {
        const PartList parts(quads.scene, rest, reach);
        const Projection projection = projection_of(looking_down(false), parts.bounds(transforms));
        const auto layers = parts.visible(transforms, projection, 0);
        const uint32_t count = reach == Reach::mesh ? 4 : 2;
        CHECK(layers[static_cast<size_t>(Layer::opaque)] == std::vector<FaceRange>{{0, count}});
    }
}
