// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to directions.
#ifndef AGLOW_SHARED_SAMPLING_H
#define AGLOW_SHARED_SAMPLING_H
#include "aglow/shared/glsl.h"
AG_NAMESPACE_BEGIN

// The unit square onto the unit disk, area to area and with little distortion.
// Source: Shirley & Chiu, "A Low Distortion Map Between Disk and Square", 1997.
AG_FN vec2 concentric_disk(vec2 u) {
    vec2 result;
    float a = 2.0f * u.x - 1.0f;
    float b = 2.0f * u.y - 1.0f;
    if (a == 0.0f && b == 0.0f) {
        result.x = 0.0f;
        result.y = 0.0f;
        return result;
    }
    bool wide = abs(a) > abs(b);
    float radius = wide ? a : b;
    float angle = wide ? 0.78539816f * (b / a) : 1.57079633f - 0.78539816f * (a / b);
    result.x = radius * cos(angle);
    result.y = radius * sin(angle);
    return result;
}

// A direction with density cos(theta) / pi about +z.
AG_FN vec3 cosine_hemisphere(vec2 u) {
    vec2 disk = concentric_disk(u);
    vec3 result;
    result.x = disk.x;
    result.y = disk.y;
    result.z = sqrt(max(0.0f, 1.0f - disk.x * disk.x - disk.y * disk.y));
    return result;
}

// `local`, given in a frame whose z is the unit vector n, in the space of n.
// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
AG_FN vec3 around_normal(vec3 local, vec3 n) {
    float side = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (side + n.z);
    float b = n.x * n.y * a;
    vec3 tangent;
    tangent.x = 1.0f + side * n.x * n.x * a;
    tangent.y = side * b;
    tangent.z = -side * n.x;
    vec3 bitangent;
    bitangent.x = b;
    bitangent.y = side + n.y * n.y * a;
    bitangent.z = -n.y;
    return tangent * local.x + bitangent * local.y + n * local.z;
}

AG_NAMESPACE_END
#endif
