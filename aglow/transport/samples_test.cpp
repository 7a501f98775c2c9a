// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/samples.h"

#include "aglow/shared/sobol.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace aglow;
using namespace aglow::transport::cpu;

TEST_CASE("batches of samples are the scrambled Sobol points one by one") {
    const Samples samples(3, 17, 1);
    const uint32_t seed =
        shared::hash_pair(shared::hash_pair(static_cast<uint32_t>(mix_bits(3)), 17), 1);
    for (const uint32_t first : {0u, 16u, 4096u, 1u << 20}) {
        Draws draws;
        samples.draw(first, draws);
        for (uint32_t i = 0; i < kBatch; ++i) {
            const shared::SobolPoint p = shared::sobol_point(first + i);
            const uint32_t coordinates[] = {p.x, p.y, p.z, p.w, p.x, p.y, p.x, p.y};
            for (uint32_t d = 0; d < Draws::kDimensions; ++d)
                CHECK(draws.values[d][i] ==
                      shared::owen_scramble(coordinates[d], shared::hash_pair(seed, d)));
        }
    }
}

TEST_CASE("every batch puts one sample into each sixteenth of every dimension") {
    const Samples samples(5, 1, 0);
    for (uint32_t first = 0; first < 256; first += kBatch) {
        Draws draws;
        samples.draw(first, draws);
        for (const auto& dimension : draws.values) {
            std::set<int> strata;
            for (const float u : dimension) strata.insert(static_cast<int>(std::floor(u * 16)));
            CHECK(strata.size() == 16);
        }
    }
}
