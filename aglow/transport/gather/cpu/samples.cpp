// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/samples.h"

#include "aglow/core/assert.h"
#include "aglow/core/target_clones.h"
#include "aglow/shared/sobol.h"

namespace aglow::transport::cpu {
namespace {

using shared::SobolPoint;

/// The Sobol coordinate, 0 to 3, that each dimension is made of.
constexpr uint32_t kCoordinateOf[Draws::kDimensions] = {0, 1, 2, 3, 0, 1, 0, 1};

/// [coordinate][i] of the first points. Sobol points are linear over GF(2): a batch that starts at
/// a multiple of its size is the first batch, each coordinate xor that of its start.
struct FirstBatch {
    uint32_t coordinates[4][kBatch];
    FirstBatch() {
        for (uint32_t i = 0; i < kBatch; ++i) {
            const SobolPoint p = shared::sobol_point(i);
            const uint32_t values[] = {p.x, p.y, p.z, p.w};
            for (uint32_t c = 0; c < 4; ++c) coordinates[c][i] = values[c];
        }
    }
};

AGLOW_TARGET_CLONES
void scramble(const FirstBatch& base, const uint32_t (&start)[4],
              const uint32_t (&seeds)[Draws::kDimensions], Draws& draws) {
    for (uint32_t d = 0; d < Draws::kDimensions; ++d) {
        const uint32_t c = kCoordinateOf[d];
        for (uint32_t i = 0; i < kBatch; ++i)
            draws.values[d][i] = shared::owen_scramble(base.coordinates[c][i] ^ start[c], seeds[d]);
    }
}

}  // namespace

Samples::Samples(uint64_t seed, uint32_t receiver, uint32_t purpose)
    : seed_(shared::hash_pair(shared::hash_pair(static_cast<uint32_t>(mix_bits(seed)), receiver),
                              purpose)) {
    for (uint32_t d = 0; d < Draws::kDimensions; ++d) scrambles_[d] = shared::hash_pair(seed_, d);
}

void Samples::draw(uint32_t first, Draws& draws) const {
    AG_ASSERT(first % kBatch == 0, "batches start at multiples of their size");
    static const FirstBatch base;
    const SobolPoint p = shared::sobol_point(first);
    scramble(base, {p.x, p.y, p.z, p.w}, scrambles_, draws);
}

}  // namespace aglow::transport::cpu
