// SPDX-License-Identifier: Apache-2.0
#include "aglow/shared/sobol.h"
#include "aglow/shared/sampling.h"

#include <doctest/doctest.h>

#include <set>
#include <vector>

using namespace aglow::shared;

namespace {

/// Number of distinct cells of a columns x rows grid that the first `count` points fall into.
size_t cells_hit(uint count, uint seed, uint columns, uint rows) {
    std::set<uint> cells;
    for (uint i = 0; i < count; ++i) {
        const vec2 p = owen_sobol_2d(i, seed);
        cells.insert(static_cast<uint>(p.y * static_cast<float>(rows)) * columns +
                     static_cast<uint>(p.x * static_cast<float>(columns)));
    }
    return cells.size();
}

}  // namespace

TEST_CASE("every elementary interval of a power of two holds exactly one scrambled Sobol point") {
    for (uint seed : {0u, 1u, 77u, 123456u})
        for (uint columns : {1u, 2u, 8u, 16u, 64u, 256u}) {
            CAPTURE(seed);
            CAPTURE(columns);
            CHECK(cells_hit(256, seed, columns, 256 / columns) == 256);
        }
}

TEST_CASE("each of the four coordinates is stratified, and they integrate a product of all") {
    constexpr uint kCount = 4096;
    double sum = 0;
    std::set<uint> strata[4];
    for (uint i = 0; i < kCount; ++i) {
        const SobolPoint p = sobol_point(i);
        double product = 1;
        uint k = 0;
        for (const uint coordinate : {p.x, p.y, p.z, p.w}) {
            const float u = owen_scramble(coordinate, hash_pair(5, k));
            strata[k++].insert(static_cast<uint>(u * kCount));
            product *= static_cast<double>(u);
        }
        sum += product;
    }
    for (const auto& hit : strata) CHECK(hit.size() == kCount);
    CHECK(sum / kCount == doctest::Approx(1.0 / 16).epsilon(0.003));
}

TEST_CASE("sequences of different seeds are uncorrelated") {
    constexpr uint kSeeds = 4000;
    double product = 0;
    for (uint seed = 0; seed < kSeeds; ++seed)
        product += (static_cast<double>(owen_sobol_2d(3, seed).x) - 0.5) *
                   (static_cast<double>(owen_sobol_2d(3, seed + 1).x) - 0.5);
    // The standard error of the mean of products of two uniform variates is 1/12/sqrt(n).
    CHECK(std::fabs(product / kSeeds) < 4.0 / 12 / std::sqrt(kSeeds));
}

TEST_CASE("cosine-distributed directions have mean cosine 2/3 and mean squared cosine 1/2") {
    double mean = 0, square = 0;
    constexpr uint kCount = 4096;
    for (uint i = 0; i < kCount; ++i) {
        const vec3 d = cosine_hemisphere(owen_sobol_2d(i, 9));
        CHECK(length(d) == doctest::Approx(1.0).epsilon(1e-5));
        mean += static_cast<double>(d.z) / kCount;
        square += static_cast<double>(d.z * d.z) / kCount;
    }
    CHECK(mean == doctest::Approx(2.0 / 3).epsilon(1e-4));
    CHECK(square == doctest::Approx(0.5).epsilon(1e-4));
}
