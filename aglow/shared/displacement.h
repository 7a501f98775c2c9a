// SPDX-License-Identifier: Apache-2.0
// Heights along the normals of a smooth surface, and the normals of what they make of it.
#ifndef AGLOW_SHARED_DISPLACEMENT_H
#define AGLOW_SHARED_DISPLACEMENT_H
#include "aglow/shared/noise.h"
#include "aglow/shared/texture_lookup.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kNoDisplacement = 0u;
AG_CONST uint kSineDisplacement = 1u;       // amplitude sin(frequency . P + phase)
AG_CONST uint kNoiseDisplacement = 2u;      // amplitude fbm(frequency P), by component
AG_CONST uint kHeightMapDisplacement = 3u;  // amplitude (height - middle)

// 80 bytes.
struct Displacement {
    uint kind;        // k...Displacement
    float amplitude;  // m
    vec3 frequency;   // 1/m
    float phase;
    uint octaves;
    float lacunarity, gain;
    uint seed;
    float middle;  // height that moves nothing
    float level;   // of the height map's mips
    TextureLevels map;
};
AG_BUFFER_OF(Displacement);

// Height at a place in space, and its gradient there; of a height map 0.
AG_FN Field displacement_at(Displacement d, vec3 p) {
    Field r;
    r.value = 0.0f;
    r.gradient = p * 0.0f;
    if (d.kind == kSineDisplacement) {
        float angle = dot(d.frequency, p) + d.phase;
        r.value = d.amplitude * sin(angle);
        r.gradient = d.frequency * (d.amplitude * cos(angle));
    } else if (d.kind == kNoiseDisplacement) {
        Field f = fbm(p * d.frequency, d.octaves, d.lacunarity, d.gain, d.seed);
        r.value = d.amplitude * f.value;
        r.gradient = f.gradient * d.frequency * d.amplitude;
    }
    return r;
}

// The unit normal after moving a surface with this unit normal by a height with this gradient.
// Exact for a flat surface; where the surface is curved the height must be small beside its radius.
AG_FN vec3 displaced_normal(vec3 normal, vec3 gradient) {
    vec3 along = gradient - normal * dot(gradient, normal);
    vec3 n = normal - along;
    return n / length(n);
}

// Gradient on the surface of a height, from its derivatives by two parameters and the surface's.
AG_FN vec3 surface_gradient(vec3 by_x, vec3 by_y, float height_by_x, float height_by_y) {
    vec3 n = cross(by_x, by_y);
    float square = dot(n, n);
    vec3 r = cross(by_y, n) * height_by_x + cross(n, by_x) * height_by_y;
    return square > 0.0f ? r / square : n * 0.0f;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::Displacement) == 80);
#endif
#endif
