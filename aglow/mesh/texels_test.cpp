// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/texels.h"

#include "aglow/core/parallel.h"
#include "aglow/mesh/testing/meshes.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

/// A primitive whose lightmap UVs are given in texels of a width x height atlas.
struct Laid {
    Surfaces surfaces;
    Atlas atlas;
};

Laid lay(Primitive primitive, std::vector<vec2> texels, int width, int height) {
    Laid laid;
    primitive.lightmap_uvs = std::move(texels);
    laid.atlas.width = width;
    laid.atlas.height = height;
    laid.atlas.placements = {{0, 0, 0, {1, 1}, {0, 0}}};
    laid.surfaces = pose(scene_of({std::move(primitive)}), -1, &laid.atlas);
    return laid;
}

vec2 lightmap_uv(const Surfaces& s, SurfacePoint at) {
    const uvec3 t = s.triangles[at.triangle];
    return s.lightmap_uvs[t.x] * (1 - at.barycentrics.x - at.barycentrics.y) +
           s.lightmap_uvs[t.y] * at.barycentrics.x + s.lightmap_uvs[t.z] * at.barycentrics.y;
}

double total_area(const Texels& texels) {
    return std::accumulate(texels.area.begin(), texels.area.end(), 0.0);
}

/// Every sample lies in its own texel (rounding aside) and strictly inside its triangle.
void check_samples(const Laid& laid, const Texels& texels) {
    int outside = 0;
    for (size_t e = 0; e < texels.element_count(); ++e) {
        const int x = int(texels.pixel_of[e]) % texels.width;
        const int y = int(texels.pixel_of[e]) / texels.width;
        REQUIRE(texels.first_sample[e] < texels.first_sample[e + 1]);
        for (uint32_t i = texels.first_sample[e]; i < texels.first_sample[e + 1]; ++i) {
            const SurfacePoint p = texels.samples[i];
            const vec2 uv = lightmap_uv(laid.surfaces, p);
            constexpr float kRounding = 1e-4f;
            const bool inside = uv.x >= float(x) - kRounding && uv.x <= float(x + 1) + kRounding &&
                                uv.y >= float(y) - kRounding && uv.y <= float(y + 1) + kRounding;
            const bool in_triangle = p.barycentrics.x > 0 && p.barycentrics.y > 0 &&
                                     p.barycentrics.x + p.barycentrics.y < 1;
            outside += !(inside && in_triangle);
        }
    }
    CHECK(outside == 0);
}

}  // namespace

TEST_CASE("a quad laid over whole texels covers exactly these, each with its share of area") {
    const Laid laid = lay(unit_quad(), {{2, 1}, {6, 1}, {6, 4}, {2, 4}}, 8, 8);
    const Texels texels = rasterize(laid.surfaces, laid.atlas, 4);
    REQUIRE(texels.element_count() == 12);
    for (float a : texels.area) CHECK(a == doctest::Approx(1.0 / 12).epsilon(1e-6));
    CHECK(texels.pixel_of.front() == 1 * 8 + 2);
    CHECK(texels.pixel_of.back() == 3 * 8 + 5);
    CHECK(texels.element_at[3 * 8 + 5] == 11);
    CHECK(texels.element_at[0] == kNoElement);
    CHECK(texels.samples.size() == 12 * 4);
    check_samples(laid, texels);
}

TEST_CASE("the samples of a whole texel have its centre as their mean") {
    const Laid laid = lay(unit_quad(), {{2, 1}, {6, 1}, {6, 4}, {2, 4}}, 8, 8);
    for (int count : {1, 2, 3, 4, 5, 8, 16}) {
        CAPTURE(count);
        const Texels texels = rasterize(laid.surfaces, laid.atlas, count);
        for (size_t e = 0; e < texels.element_count(); ++e) {
            vec2 sum{0, 0};
            for (uint32_t i = texels.first_sample[e]; i < texels.first_sample[e + 1]; ++i)
                sum = sum + lightmap_uv(laid.surfaces, texels.samples[i]);
            const vec2 mean = sum / float(count);
            CHECK(mean.x == doctest::Approx(int(texels.pixel_of[e]) % 8 + 0.5).epsilon(2e-3));
            CHECK(mean.y == doctest::Approx(int(texels.pixel_of[e]) / 8 + 0.5).epsilon(2e-3));
        }
    }
}

TEST_CASE("a texel is covered by the thinnest overlap and not by a touch") {
    const Laid touching = lay(unit_quad(), {{1, 1}, {2, 1}, {2, 2}, {1, 2}}, 4, 4);
    CHECK(rasterize(touching.surfaces, touching.atlas, 4).element_count() == 1);
    const Laid across = lay(unit_quad(), {{1, 1}, {2.001f, 1}, {2.001f, 2}, {1, 2}}, 4, 4);
    const Texels texels = rasterize(across.surfaces, across.atlas, 4);
    REQUIRE(texels.element_count() == 2);
    CHECK(texels.area[1] == doctest::Approx(0.001 / 1.001).epsilon(1e-2));
    check_samples(across, texels);
}

TEST_CASE("mirrored UVs cover the same texels") {
    const Laid plain = lay(unit_quad(), {{0.3f, 1}, {6, 1.7f}, {6, 4}, {2, 4}}, 8, 8);
    const Laid mirrored = lay(unit_quad(), {{7.7f, 1}, {2, 1.7f}, {2, 4}, {6, 4}}, 8, 8);
    const Texels a = rasterize(plain.surfaces, plain.atlas, 4);
    const Texels b = rasterize(mirrored.surfaces, mirrored.atlas, 4);
    REQUIRE(a.element_count() == b.element_count());
    CHECK(total_area(a) == doctest::Approx(1).epsilon(1e-6));
    CHECK(total_area(b) == doctest::Approx(1).epsilon(1e-6));
    check_samples(mirrored, b);
}

TEST_CASE("many tiny triangles in one texel share its samples by area") {
    // 2 x 64 x 64 triangles of a unit square in four texels; x < 1/4 has a quarter of the points.
    Primitive grid = sheet(64, 64, [](float u, float v) { return vec3{u, v, 0}; });
    std::vector<vec2> uvs;
    for (const vec3& p : grid.positions) uvs.push_back({1 + 2 * p.x, 1 + 2 * p.y});
    const Laid laid = lay(grid, uvs, 4, 4);
    const Texels texels = rasterize(laid.surfaces, laid.atlas, 64);
    REQUIRE(texels.element_count() == 4);
    for (float a : texels.area) CHECK(a == doctest::Approx(0.25).epsilon(1e-5));
    int left = 0;
    for (const SurfacePoint& p : texels.samples) left += position(laid.surfaces, p).x < 0.25f;
    CHECK(left == 64);
    check_samples(laid, texels);
}

TEST_CASE("samples favour the part of a texel that holds more surface") {
    // Two triangles of one texel, the second with three times the surface of the first.
    Primitive bent = primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 3, 0}, {-1, 3, 0}, {-1, 0, 0}},
                               {{0, 1, 2}, {3, 4, 5}});
    const Laid laid = lay(bent, {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}}, 1, 1);
    const Texels texels = rasterize(laid.surfaces, laid.atlas, 16);
    REQUIRE(texels.element_count() == 1);
    CHECK(texels.area[0] == doctest::Approx(2).epsilon(1e-6));
    int in_second = 0;
    for (const SurfacePoint& p : texels.samples) in_second += p.triangle == 1;
    CHECK(in_second == 12);
    check_samples(laid, texels);
}

TEST_CASE("triangles without area cover nothing") {
    Primitive p = unit_quad();
    p.triangles.push_back({0, 0, 1});
    p.positions.push_back({0.5f, 0, 0});
    p.normals.push_back({0, 0, 1});
    p.triangles.push_back({0, 1, 4});
    const Laid laid = lay(p, {{2, 1}, {6, 1}, {6, 4}, {2, 4}, {7, 7}}, 8, 8);
    CHECK(rasterize(laid.surfaces, laid.atlas, 4).element_count() == 12);
}

TEST_CASE("texels are the same for one thread and for two") {
    Primitive ball = sphere(40, 20);
    std::vector<vec2> uvs;
    for (size_t i = 0; i < ball.positions.size(); ++i)
        uvs.push_back({1.3f + 3 * float(i % 41), 1.7f + 5.9f * float(i / 41)});
    const Laid laid = lay(ball, uvs, 128, 128);
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return rasterize(laid.surfaces, laid.atlas, 5);
    };
    const Texels one = run(1), two = run(2);
    CHECK(one.pixel_of == two.pixel_of);
    CHECK(one.area == two.area);
    REQUIRE(one.samples.size() == two.samples.size());
    bool same = true;
    for (size_t i = 0; i < one.samples.size(); ++i)
        same = same && one.samples[i].triangle == two.samples[i].triangle &&
               one.samples[i].barycentrics == two.samples[i].barycentrics;
    CHECK(same);
    check_samples(laid, one);
}
