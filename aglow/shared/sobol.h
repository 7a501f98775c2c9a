// SPDX-License-Identifier: Apache-2.0
// Owen-scrambled Sobol points in two and three dimensions, by hashing: point `index` of the
// sequence that belongs to `seed`. Every prefix of 2^k points is stratified; sequences of different
// seeds are independent.
//
// Source: Joe & Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections",
// SIAM J. Sci. Comput. 2008 (direction numbers); Laine & Karras, "Stratified Sampling for
// Stochastic Transparency", EGSR 2011 and Burley, "Practical Hash-based Owen Scrambling", JCGT
// 2020.
#ifndef AGLOW_SHARED_SOBOL_H
#define AGLOW_SHARED_SOBOL_H
#include "aglow/shared/glsl.h"
AG_NAMESPACE_BEGIN

// A bijection of 32 bits that flips about half of the output bits for each input bit (Wellons,
// "Prospecting for Hash Functions", 2018: lowbias32).
AG_FN uint hash_bits(uint x) {
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

AG_FN uint hash_pair(uint a, uint b) { return hash_bits(hash_bits(a) + 0x9e3779b9u + b); }

AG_FN uint reverse_bits(uint x) {
    x = (x << 16u) | (x >> 16u);
    x = ((x & 0x00ff00ffu) << 8u) | ((x & 0xff00ff00u) >> 8u);
    x = ((x & 0x0f0f0f0fu) << 4u) | ((x & 0xf0f0f0f0u) >> 4u);
    x = ((x & 0x33333333u) << 2u) | ((x & 0xccccccccu) >> 2u);
    return ((x & 0x55555555u) << 1u) | ((x & 0xaaaaaaaau) >> 1u);
}

// Owen scrambling: each bit is flipped depending on the bits above it only. The multiplications
// by even numbers carry from low to high bits, hence the reversals around them.
AG_FN uint owen_scramble(uint x, uint seed) {
    x = reverse_bits(x) + seed;
    x = x ^ (x * 0x6c50b47cu);
    x = x ^ (x * 0xb82f1e52u);
    x = x ^ (x * 0xc7afe638u);
    x = x ^ (x * 0x8d22f6e6u);
    return reverse_bits(x);
}

// The first three Sobol coordinates of `index` as 32-bit fractions. Direction numbers of the second
// follow v' = v ^ (v >> 1); of the third, with polynomial x^2 + x + 1 and initial numbers
// 1, 3, v'' = v' ^ v ^ (v >> 2) with v scaled to its bit.
AG_FN uvec3 sobol_bits(uint index) {
    uvec3 point;
    point.x = reverse_bits(index);
    point.y = 0u;
    point.z = 0u;
    uint second = 0x80000000u;
    uint third = 0x80000000u;
    uint third_next = 0xc0000000u;
    for (uint rest = index; rest != 0u; rest = rest >> 1u) {
        if ((rest & 1u) != 0u) {
            point.y = point.y ^ second;
            point.z = point.z ^ third;
        }
        second = second ^ (second >> 1u);
        uint third_after = third_next ^ third ^ (third >> 2u);
        third = third_next;
        third_next = third_after;
    }
    return point;
}

// The 24 leading bits as a float in [0, 1).
AG_FN float unit_float(uint bits) { return float(bits >> 8u) * 5.9604645e-8f; }

// Shuffling the index by an Owen scramble keeps every 2^k prefix a (0, k, 2)-net while making
// sequences of different seeds independent of each other.
AG_FN vec2 owen_sobol_2d(uint index, uint seed) {
    uvec3 p = sobol_bits(owen_scramble(index, hash_bits(seed)));
    vec2 result;
    result.x = unit_float(owen_scramble(p.x, hash_pair(seed, 1u)));
    result.y = unit_float(owen_scramble(p.y, hash_pair(seed, 2u)));
    return result;
}

AG_FN vec3 owen_sobol_3d(uint index, uint seed) {
    uvec3 p = sobol_bits(owen_scramble(index, hash_bits(seed)));
    vec3 result;
    result.x = unit_float(owen_scramble(p.x, hash_pair(seed, 1u)));
    result.y = unit_float(owen_scramble(p.y, hash_pair(seed, 2u)));
    result.z = unit_float(owen_scramble(p.z, hash_pair(seed, 3u)));
    return result;
}

AG_NAMESPACE_END
#endif
