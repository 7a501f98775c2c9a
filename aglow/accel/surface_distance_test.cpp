// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/surface_distance.h"

#include "aglow/core/random.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace aglow;

namespace {

/// The unit square at height z, of n x n pairs of triangles.
struct Square {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;

    explicit Square(float z, uint32_t n = 4) {
        for (uint32_t j = 0; j <= n; ++j)
            for (uint32_t i = 0; i <= n; ++i)
                positions.push_back({float(i) / float(n), float(j) / float(n), z});
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i < n; ++i) {
                const uint32_t a = j * (n + 1) + i, b = a + n + 1;
                triangles.push_back({a, a + 1, b + 1});
                triangles.push_back({a, b + 1, b});
            }
    }
    TriangleSurface surface() const { return {positions, triangles}; }
};

}  // namespace

TEST_CASE("distances from a square have their closed form in all regions round it") {
    const Square square(0);
    Pcg32 random(3);
    std::vector<vec3> points;
    for (int i = 0; i < 2000; ++i)
        points.push_back(
            {4 * random.uniform() - 1.5f, 4 * random.uniform() - 1.5f, 4 * random.uniform() - 2});
    const auto found = distances(points, square.surface());
    REQUIRE(found);
    for (size_t i = 0; i < points.size(); ++i) {
        const vec3 p = points[i];
        const double x = p.x - std::clamp(p.x, 0.0f, 1.0f), y = p.y - std::clamp(p.y, 0.0f, 1.0f);
        CHECK((*found)[i] ==
              doctest::Approx(std::sqrt(x * x + y * y + double(p.z) * p.z)).epsilon(1e-5));
    }
}

TEST_CASE("triangles without area have the distance of their edges") {
    const std::array<vec3, 3> positions = {vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    const std::array<uvec3, 3> triangles = {uvec3{0, 1, 2}, {0, 0, 1}, {1, 1, 1}};
    const std::array<vec3, 3> points = {vec3{1.5f, 2, 0}, {-1, 0, 0}, {1, 0, 3}};
    const auto found = distances(points, {positions, triangles});
    REQUIRE(found);
    CHECK((*found)[0] == doctest::Approx(2));
    CHECK((*found)[1] == doctest::Approx(1));
    CHECK((*found)[2] == doctest::Approx(3));
}

TEST_CASE("parallel squares are apart by their distance, on the mean and at most") {
    const Square a(0), b(0.25f, 7);
    const auto difference = surface_difference(a.surface(), b.surface(), 1000);
    REQUIRE(difference);
    CHECK(difference->rms == doctest::Approx(0.25));
    CHECK(difference->hausdorff == doctest::Approx(0.25));
    CHECK(difference->samples == 2000 + 25 + 64);
}

TEST_CASE("the larger of both directions counts: a surface and a part of it") {
    const Square whole(0, 4);
    Square part = whole;
    part.triangles.resize(part.triangles.size() / 2);  // the lower half
    const auto difference = surface_difference(part.surface(), whole.surface(), 20'000);
    REQUIRE(difference);
    CHECK(difference->hausdorff == doctest::Approx(0.5));
    // Half of the whole is at distances 0 .. 1/2: the mean square is 1/2 * (1/2)^2 / 3.
    CHECK(difference->rms == doctest::Approx(std::sqrt(1.0 / 24)).epsilon(0.01));
}

TEST_CASE("nothing is infinitely far from something, and not at all from nothing") {
    const Square square(0);
    const auto far = surface_difference(square.surface(), {}, 10);
    REQUIRE(far);
    CHECK(std::isinf(far->rms));
    const auto none = surface_difference({}, {}, 10);
    REQUIRE(none);
    CHECK(none->rms == 0);
    CHECK(none->hausdorff == 0);
}
