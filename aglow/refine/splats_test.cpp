// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/splats.h"

#include "aglow/core/random.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace aglow;

TEST_CASE("splats cover every point of their triangles, and not much more") {
    Pcg32 random(8);
    const auto point = [&] { return vec3{random.uniform(), 3 * random.uniform(), 0}; };
    const std::array<vec3, 3> up = {vec3{0, 0, 1}, vec3{0, 0, 1}, vec3{0, 0, 1}};
    const std::array<uvec3, 1> all = {uvec3{0, 1, 2}};
    for (int round = 0; round < 100; ++round) {
        const std::array<vec3, 3> corners = {point(), point(), point()};
        const std::vector<Splat> splats = make_splats(corners, up, all);
        float longest = 0;
        for (size_t i = 0; i < 3; ++i)
            longest = std::max(longest, length(corners[i] - corners[(i + 1) % 3]));
        for (int i = 0; i < 200; ++i) {
            float u = random.uniform(), v = random.uniform();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const vec3 p = corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
            const bool covered = std::ranges::any_of(splats, [&](const Splat& s) {
                return length(p - s.position) <= s.radius * 1.0001f;
            });
            CHECK(covered);
        }
        for (const Splat& s : splats) CHECK(s.radius <= 0.578f * longest);  // an equilateral one
    }
}
