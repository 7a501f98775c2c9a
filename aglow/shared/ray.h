// SPDX-License-Identifier: Apache-2.0
// Rays, what they hit, and the triangles and boxes that acceleration structures are made of.
#ifndef AGLOW_SHARED_RAY_H
#define AGLOW_SHARED_RAY_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

// Points origin + t * direction with near < t < far. The direction may have any length but zero
// and any number of zero components; t counts in its lengths. 32 bytes.
struct RayQuery {
    vec3 origin;
    float near;
    vec3 direction;
    float far;
};

AG_CONST uint kNoTriangle = 0xffffffffu;

// The nearest triangle on a ray. Barycentrics are the weights of corners b and c. 16 bytes.
struct RayHit {
    float t;
    uint triangle;  // index into all triangles of the scene; kNoTriangle: nothing was hit
    vec2 barycentrics;
};

struct Triangle {
    vec3 a, b, c;
};

struct Bounds {
    vec3 lower, upper;  // lower > upper: holds nothing
};

// x' = x * p.x + y * p.y + z * p.z + t
struct Affine {
    vec3 x, y, z, t;
};

AG_BUFFER_OF(RayQuery);
AG_BUFFER_OF(RayHit);
AG_BUFFER_OF(Triangle);
AG_BUFFER_OF(Bounds);
AG_BUFFER_OF(Affine);

AG_FN vec3 transform_point(Affine m, vec3 p) { return m.x * p.x + m.y * p.y + m.z * p.z + m.t; }
AG_FN vec3 transform_direction(Affine m, vec3 d) { return m.x * d.x + m.y * d.y + m.z * d.z; }

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RayQuery) == 32);
static_assert(sizeof(aglow::shared::RayHit) == 16);
static_assert(sizeof(aglow::shared::Triangle) == 36);
static_assert(sizeof(aglow::shared::Affine) == 48);
#endif
#endif
