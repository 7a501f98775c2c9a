// SPDX-License-Identifier: Apache-2.0
// Light that arrives at a point straight from its source, before anything stands in its way.
#ifndef AGLOW_SHARED_LIGHT_H
#define AGLOW_SHARED_LIGHT_H
#include "aglow/shared/ray.h"
#include "aglow/shared/sampling.h"
#include "aglow/shared/sobol.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kLightPoint = 0u;
AG_CONST uint kLightSpot = 1u;
AG_CONST uint kLightDirectional = 2u;
AG_CONST uint kLightPhotometric = 3u;

AG_CONST float kFarAway = 3.0e38f;  // distance of the sun and the sky, m

// A light without extent, in world space: KHR_lights_punctual, or a luminaire with photometry.
// 84 bytes.
struct PunctualLight {
    vec3 position;
    vec3 axis;       // unit, along which it shines
    vec3 right, up;  // unit, towards C0 and C90 of a luminaire's photometry
    vec3 intensity;  // candela; lux for a directional one; a factor for a photometric one
    uint kind;       // kLight...
    float cone_scale, cone_offset;  // of a spot: share = clamp(cosine * scale + offset, 0, 1)^2
    // Of a photometric light, in an array of floats: at `photometry` the angles gamma, then the
    // angles C, then candela [c_count][gamma_count]. See aglow/scene/photometry.h.
    uint photometry;
    uint gamma_count, c_count;
};
AG_BUFFER_OF(PunctualLight);

// What reaches a point from one direction.
struct LightArrival {
    vec3 direction;          // unit, towards the light
    float distance;          // m that have to be free
    vec3 normal_irradiance;  // on a plane that faces it, lux
};

// Of a photometric light, multiply normal_irradiance by its table at photometric_angles() of
// photometric_direction().
AG_FN LightArrival punctual_arrival(PunctualLight light, vec3 p) {
    LightArrival arrival;
    arrival.direction = -light.axis;
    arrival.distance = kFarAway;
    arrival.normal_irradiance = light.intensity;
    if (light.kind == kLightDirectional) return arrival;

    vec3 to_light = light.position - p;
    float distance = length(to_light);
    arrival.distance = distance;
    if (!(distance > 0.0f)) {
        arrival.normal_irradiance = light.intensity * 0.0f;
        return arrival;
    }
    arrival.direction = to_light / distance;
    float share = 1.0f;
    if (light.kind == kLightSpot) {
        float t = clamp(-dot(light.axis, arrival.direction) * light.cone_scale + light.cone_offset,
                        0.0f, 1.0f);
        share = t * t;
    }
    // Dividing twice keeps the square of a very small or large distance in range.
    arrival.normal_irradiance = light.intensity * share / distance / distance;
    return arrival;
}

// The direction away from a luminaire in its own frame: aimed along -z, C0 along +x.
AG_FN vec3 photometric_direction(PunctualLight light, vec3 to_light) {
    vec3 d;
    d.x = -dot(to_light, light.right);
    d.y = -dot(to_light, light.up);
    d.z = dot(to_light, light.axis);
    return d;
}

// gamma (from the axis) and C (about it, in [-180, 180]) of that direction, degrees.
AG_FN vec2 photometric_angles(vec3 direction) {
    float degrees = 57.2957795f;
    vec2 angles;
    angles.x =
        atan(sqrt(direction.x * direction.x + direction.y * direction.y), -direction.z) * degrees;
    angles.y = atan(direction.y, direction.x) * degrees;
    return angles;
}

// One point on an emissive triangle as a point p on a plane with normal n sees it. The irradiance
// that all emissive triangles give is estimated by weight * luminance * visibility.
struct EmitterSample {
    vec2 barycentrics;
    vec3 direction;  // unit, from p
    float distance;  // m
    float weight;    // sr; 0: no light comes this way
    uint front;      // 1: p is on the front of the triangle
};

// Points are even over the triangle, which was chosen with `probability`. Nothing can shine more
// than a hemisphere full of its luminance does, so weights end at pi: a bias within a lamp's own
// size of it instead of bright specks.
AG_FN EmitterSample sample_emitter(Triangle triangle, float probability, vec2 u, vec3 p, vec3 n) {
    float root = sqrt(u.x);
    EmitterSample result;
    result.barycentrics.x = root * (1.0f - u.y);
    result.barycentrics.y = root * u.y;
    vec3 ab = triangle.b - triangle.a;
    vec3 ac = triangle.c - triangle.a;
    vec3 to_light = triangle.a + ab * result.barycentrics.x + ac * result.barycentrics.y - p;
    float distance = length(to_light);
    vec3 twice_area = cross(ab, ac);
    result.direction = distance > 0.0f ? to_light / distance : n;
    result.distance = distance;
    float leaving = -dot(twice_area, result.direction);
    float arriving = max(dot(n, result.direction), 0.0f);
    result.front = leaving > 0.0f ? 1u : 0u;
    float weight = distance > 0.0f && probability > 0.0f
                       ? 0.5f * abs(leaving) * arriving / distance / distance / probability
                       : 0.0f;
    result.weight = min(weight, 3.14159265f);
    return result;
}

// Seeds of the Sobol points that stratify what the camera samples of one pixel need: a sequence of
// its own for each use of random numbers (kDraw...) at each depth of reflection.
AG_CONST uint kDrawEmitter = 0u;
AG_CONST uint kDrawSky = 1u;
AG_FN uint draw_seed(uint seed, uint pixel, uint depth, uint draw) {
    return hash_pair(hash_pair(seed, pixel), 2u * depth + draw);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PunctualLight) == 84);
#endif
#endif
