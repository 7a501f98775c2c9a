// SPDX-License-Identifier: Apache-2.0
// Owen-scrambled Sobol points in four dimensions, by hashing. Every prefix of 2^k points is
// stratified in the square of the first two coordinates and in each coordinate; scrambles by
// different seeds make independent sequences out of the same points. Two integrands that are only
// added up may share coordinates under different seeds.
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

// Coordinates of a Sobol point as 32-bit fractions with their bits reversed: the most significant
// binary digit is bit 0, which is the order that owen_scramble() works in.
struct SobolPoint {
    uint x, y, z, w;
};

// Direction numbers, reversed like the points, follow from those before them: y(k+1) = y(k) ^ 2
// y(k) and, for the primitive polynomials t^2 + t + 1 and t^3 + t + 1, z(k+2) = z(k+1) ^ z(k) ^ 4
// z(k) and w(k+3) = w(k+1) ^ w(k) ^ 8 w(k). Initial numbers are 1, 3 for z and 1, 3, 1 for w.
AG_FN SobolPoint sobol_point(uint index) {
    SobolPoint point;
    point.x = index;
    point.y = 0u;
    point.z = 0u;
    point.w = 0u;
    uint y = 1u;
    uint z0 = 1u;
    uint z1 = 3u;
    uint w0 = 1u;
    uint w1 = 3u;
    uint w2 = 4u;
    for (uint rest = index; rest != 0u; rest = rest >> 1u) {
        uint digit = 0u - (rest & 1u);
        point.y = point.y ^ (y & digit);
        point.z = point.z ^ (z0 & digit);
        point.w = point.w ^ (w0 & digit);
        y = y ^ (y << 1u);
        uint z2 = z1 ^ z0 ^ (z0 << 2u);
        z0 = z1;
        z1 = z2;
        uint w3 = w1 ^ w0 ^ (w0 << 3u);
        w0 = w1;
        w1 = w2;
        w2 = w3;
    }
    return point;
}

// The 24 leading bits as a float in [0, 1).
AG_FN float unit_float(uint bits) { return float(int(bits >> 8u)) * 5.9604645e-8f; }

// Owen scrambling of a reversed coordinate, as a float in [0, 1): each binary digit is flipped
// depending on the digits before it. Multiplications by even numbers carry from bit 0 upwards,
// that is, from each digit to those behind it.
AG_FN float owen_scramble(uint reversed, uint seed) {
    uint x = reversed + seed;
    x = x ^ (x * 0x6c50b47cu);
    x = x ^ (x * 0xb82f1e52u);
    x = x ^ (x * 0xc7afe638u);
    x = x ^ (x * 0x8d22f6e6u);
    return unit_float(reverse_bits(x));
}

AG_FN vec2 owen_sobol_2d(uint index, uint seed) {
    SobolPoint p = sobol_point(index);
    vec2 result;
    result.x = owen_scramble(p.x, hash_pair(seed, 1u));
    result.y = owen_scramble(p.y, hash_pair(seed, 2u));
    return result;
}

AG_FN vec3 owen_sobol_3d(uint index, uint seed) {
    SobolPoint p = sobol_point(index);
    vec3 result;
    result.x = owen_scramble(p.x, hash_pair(seed, 1u));
    result.y = owen_scramble(p.y, hash_pair(seed, 2u));
    result.z = owen_scramble(p.z, hash_pair(seed, 3u));
    return result;
}

AG_NAMESPACE_END
#endif
