// SPDX-License-Identifier: Apache-2.0
// Gradient noise in space, and sums of octaves of it, with derivatives.
//
// Source: Perlin, "Improving Noise", SIGGRAPH 2002 (the quintic fade); gradients here are hashed
// from their cell and of random length.
#ifndef AGLOW_SHARED_NOISE_H
#define AGLOW_SHARED_NOISE_H
#include "aglow/shared/sobol.h"
AG_NAMESPACE_BEGIN

// A value and its gradient.
struct Field {
    float value;
    vec3 gradient;
};

// Twice its signed part of 10 bits: in [-1, 1).
AG_FN float noise_component(uint bits) { return float(int(bits & 1023u) - 512) / 512.0f; }

AG_FN vec3 noise_gradient(int x, int y, int z, uint seed) {
    uint h = hash_pair(hash_pair(hash_pair(seed, uint(x)), uint(y)), uint(z));
    vec3 r;
    r.x = noise_component(h);
    r.y = noise_component(h >> 10u);
    r.z = noise_component(h >> 20u);
    return r;
}

// t^3 (10 - 15 t + 6 t^2), and its derivative.
AG_FN float noise_fade(float t) { return t * t * t * (10.0f + t * (6.0f * t - 15.0f)); }
AG_FN float noise_fade_slope(float t) { return 30.0f * t * t * (t * (t - 2.0f) + 1.0f); }

// Noise of period-free cells of edge 1; 0 at their corners, about -1 .. 1 between.
AG_FN Field gradient_noise(vec3 p, uint seed) {
    // Further away a float has no fraction anyway.
    vec3 q;
    vec3 cell;
    q.x = clamp(p.x, -1.0e9f, 1.0e9f);
    q.y = clamp(p.y, -1.0e9f, 1.0e9f);
    q.z = clamp(p.z, -1.0e9f, 1.0e9f);
    cell.x = floor(q.x);
    cell.y = floor(q.y);
    cell.z = floor(q.z);
    vec3 d = q - cell;
    vec3 near_weight;
    vec3 slope;
    near_weight.x = 1.0f - noise_fade(d.x);
    near_weight.y = 1.0f - noise_fade(d.y);
    near_weight.z = 1.0f - noise_fade(d.z);
    slope.x = noise_fade_slope(d.x);
    slope.y = noise_fade_slope(d.y);
    slope.z = noise_fade_slope(d.z);

    Field sum;
    sum.value = 0.0f;
    sum.gradient = d * 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        int i = corner & 1;
        int j = (corner >> 1) & 1;
        int k = corner >> 2;
        vec3 offset;
        offset.x = d.x - float(i);
        offset.y = d.y - float(j);
        offset.z = d.z - float(k);
        vec3 g = noise_gradient(int(cell.x) + i, int(cell.y) + j, int(cell.z) + k, seed);
        float height = dot(g, offset);
        float x = i == 0 ? near_weight.x : 1.0f - near_weight.x;
        float y = j == 0 ? near_weight.y : 1.0f - near_weight.y;
        float z = k == 0 ? near_weight.z : 1.0f - near_weight.z;
        vec3 change;
        change.x = (i == 0 ? -slope.x : slope.x) * y * z;
        change.y = (j == 0 ? -slope.y : slope.y) * x * z;
        change.z = (k == 0 ? -slope.z : slope.z) * x * y;
        sum.value = sum.value + height * (x * y * z);
        sum.gradient = sum.gradient + g * (x * y * z) + change * height;
    }
    return sum;
}

// Fractional Brownian motion: octaves of noise, each `lacunarity` times as fine and `gain` times as
// high as the one before.
AG_FN Field fbm(vec3 p, uint octaves, float lacunarity, float gain, uint seed) {
    Field sum;
    sum.value = 0.0f;
    sum.gradient = p * 0.0f;
    float frequency = 1.0f;
    float height = 1.0f;
    for (uint octave = 0u; octave < octaves; ++octave) {
        Field f = gradient_noise(p * frequency, seed + octave);
        sum.value = sum.value + f.value * height;
        sum.gradient = sum.gradient + f.gradient * (height * frequency);
        frequency = frequency * lacunarity;
        height = height * gain;
    }
    return sum;
}

AG_NAMESPACE_END
#endif
