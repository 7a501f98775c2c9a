// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace aglow {

/// Spreads any 64 bits over all 64 (Steele, Lea & Flood, "Fast Splittable Pseudorandom Number
/// Generators", OOPSLA 2014: the mixer of SplitMix64).
inline uint64_t mix_bits(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Pseudorandom numbers, one stream per (seed, stream) pair.
/// Source  O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
///         for Random Number Generation", 2014: PCG-XSH-RR 64/32.
class Pcg32 {
public:
    explicit Pcg32(uint64_t seed, uint64_t stream = 0)
        : state_(mix_bits(seed)), increment_(mix_bits(stream) | 1u) {
        next();
    }
    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005u + increment_;
        const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
        const auto rotation = static_cast<uint32_t>(old >> 59);
        return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
    }
    float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }  ///< in [0, 1)

private:
    uint64_t state_;
    uint64_t increment_;
};

}  // namespace aglow
