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
AG_CONST uint kMixedDisplacement = 4u;      // what is displaced has one of these in each part

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

// A unit vector that varies over a face, and its derivatives by the face's parameters.
struct UnitField {
    vec3 at, by_x, by_y;
};

// Of a sum that is made unit. A sum of 0 gives 0.
AG_FN UnitField unit_field(vec3 sum, vec3 by_x, vec3 by_y) {
    float size = length(sum);
    float inverse = size > 0.0f ? 1.0f / size : 0.0f;
    UnitField r;
    r.at = sum * inverse;
    r.by_x = (by_x - r.at * dot(r.at, by_x)) * inverse;
    r.by_y = (by_y - r.at * dot(r.at, by_y)) * inverse;
    return r;
}

// The unit normal of P + height direction, from the derivatives by_x and by_y of P. `otherwise`
// where there is none.
AG_FN vec3 raised_normal(vec3 by_x, vec3 by_y, UnitField direction, float height, float height_by_x,
                         float height_by_y, vec3 otherwise) {
    vec3 x = by_x + direction.at * height_by_x + direction.by_x * height;
    vec3 y = by_y + direction.at * height_by_y + direction.by_y * height;
    vec3 n = cross(x, y);
    float size = length(n);
    return size > 0.0f ? n / size : otherwise;
}

// Heights of a flat face have slopes of its own, that those of its neighbours, which stand on other
// planes, do not go on with. They are looked up at the corners of a smaller copy of the face that
// lies in it as its point does, `share` times as large: never beyond an edge.
//
// `texels`: of level 0, that are one at the mip level; `longest`: such texels along the face.
AG_FN float slope_share(float texels, float longest) {
    return longest > 3.0f * texels ? 1.5f * texels / longest : 0.5f;
}

// Corner of the smaller copy.
AG_FN vec2 slope_corner(vec2 at, vec2 corner, float share) { return at + (corner - at) * share; }

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::Displacement) == 80);
#endif
#endif
