// SPDX-License-Identifier: Apache-2.0
// Where rays meet triangles, against the same in higher precision.
#include "aglow/core/math.h"
#include "aglow/core/random.h"
#include "aglow/shared/triangle.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace aglow;

namespace {

using Point = std::array<long double, 3>;

Point between(vec3 from, vec3 to) {
    return {static_cast<long double>(to.x) - from.x, static_cast<long double>(to.y) - from.y,
            static_cast<long double>(to.z) - from.z};
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// How far off the triangle's plane test says the ray meets it; nothing for a miss.
double distance_error(const shared::Triangle& t, vec3 origin, vec3 direction) {
    const auto hit = shared::intersect_triangle(shared::sheared_ray(origin, direction), t,
                                                -kInfinity, kInfinity);
    if (hit.hit == 0) return 0;
    const Point normal = cross(between(t.a, t.b), between(t.a, t.c));
    const long double exact =
        dot(normal, between(origin, t.a)) / dot(normal, between({0, 0, 0}, direction));
    return static_cast<double>(std::abs(hit.t - exact));
}

/// Share of rays of slope `slope` to triangles `thin` times as high as long, within lengths of
/// about 1 and coordinates up to 4, whose distance errs by more than 2^-20 of the coordinates.
double share_of_errors(float thin, float slope) {
    Pcg32 random(3);
    const auto number = [&](float size) { return size * (2 * random.uniform() - 1); };
    const auto vector = [&](float size) {
        const float x = number(size), y = number(size), z = number(size);
        return vec3{x, y, z};
    };
    constexpr int kCount = 20000;
    int off = 0;
    for (int i = 0; i < kCount; ++i) {
        const vec3 a = vector(1);
        const shared::Triangle t{a, a + vector(1), a + vector(thin)};
        const float u = random.uniform(), v = (1 - u) * random.uniform();
        const vec3 at = t.a * (1 - u - v) + t.b * u + t.c * v;
        const vec3 normal = normalize(shared::cross(t.b - t.a, t.c - t.a));
        vec3 along = vector(1);
        along = normalize(along - normal * dot(along, normal));
        const vec3 direction = normalize(along + normal * slope);
        off +=
            distance_error(t, at - direction * (0.01f * random.uniform()), direction) > 4 * 0x1p-20;
    }
    return static_cast<double>(off) / kCount;
}

}  // namespace

TEST_CASE("a ray along a long beam meets its thin side where that is") {
    // Beam and ray stand in the built-in living room.
    const shared::Triangle side{{-0x1.8624dep-1f, 0x1.32b3fcp-3f, 0x1.76d89ap+0f},
                                {-0x1.34650ap+0f, 0x1.300a14p-3f, 0x1.765908p+0f},
                                {-0x1.8624dep-1f, 0x1.300a14p-3f, 0x1.765908p+0f}};
    CHECK(distance_error(side, {-0x1.161b32p+0f, 0x1.32c0bap-3f, 0x1.76d93ap+0f},
                         {0x1.4c716cp-1f, -0x1.b54f2ep-2f, -0x1.42345cp-1f}) < 1e-7);
}

TEST_CASE("distances to needles that rays graze are as good as those to their planes") {
    CHECK(share_of_errors(1, 1) == 0);
    CHECK(share_of_errors(1, 0.1f) < 1e-3);
    CHECK(share_of_errors(0.01f, 0.1f) < 1e-3);
    CHECK(share_of_errors(0.01f, 0.01f) < 1e-2);
}

TEST_CASE("a ray does not meet the triangle that it starts on") {
    const shared::Triangle t{{-1, 0.3f, -1}, {-1, 0.3f, 2}, {2, 0.3f, -1}};
    for (const float y : {-1.0f, -0.25f, 0.25f, 1.0f}) {
        const auto ray = shared::sheared_ray({0, 0.3f, 0}, normalize(vec3{1, y, 0.5f}));
        CHECK(shared::intersect_triangle(ray, t, 0, kInfinity).hit == 0);
    }
}
