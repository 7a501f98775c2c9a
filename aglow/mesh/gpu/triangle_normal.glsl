// SPDX-License-Identifier: Apache-2.0
#ifndef AGLOW_MESH_GPU_TRIANGLE_NORMAL_GLSL
#define AGLOW_MESH_GPU_TRIANGLE_NORMAL_GLSL
#include "aglow/shared/ray.h"

// Unit normal of a triangle, zero if it has no area. Edges are brought to a length about one first:
// the product of very short ones would vanish.
vec3 triangle_normal(Triangle t) {
    vec3 u = t.b - t.a;
    vec3 v = t.c - t.a;
    vec3 w = max(abs(u), abs(v));
    float size = max(w.x, max(w.y, w.z));
    if (!(size > 0.0f)) return vec3(0.0f);
    vec3 n = cross(u / size, v / size);
    float norm = length(n);
    return norm > 0.0f ? n / norm : vec3(0.0f);
}

#endif
