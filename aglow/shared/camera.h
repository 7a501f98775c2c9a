// SPDX-License-Identifier: Apache-2.0
// From pixel positions to rays, and how wide the rays are.
#ifndef AGLOW_SHARED_CAMERA_H
#define AGLOW_SHARED_CAMERA_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

// A camera that looks along -z of `to_world`, +y up, unit axes. 72 bytes.
struct CameraView {
    Affine to_world;
    float half_width;  // tan of half the field of view, or m (orthographic)
    float half_height;
    uint perspective;    // 0: orthographic
    uint width, height;  // pixels
    uint unused;
};
AG_BUFFER_OF(CameraView);

struct CameraRay {
    vec3 origin;
    vec3 direction;  // unit
};

// The ray through (x, y) in pixels; (0, 0) is the outer corner of the top left one.
AG_FN CameraRay camera_ray(CameraView view, float x, float y) {
    vec3 on_plane;
    on_plane.x = (2.0f * x / float(view.width) - 1.0f) * view.half_width;
    on_plane.y = (1.0f - 2.0f * y / float(view.height)) * view.half_height;
    on_plane.z = view.perspective != 0u ? -1.0f : 0.0f;
    CameraRay ray;
    if (view.perspective != 0u) {
        ray.origin = view.to_world.t;
        ray.direction = normalize(transform_direction(view.to_world, on_plane));
    } else {
        ray.origin = transform_point(view.to_world, on_plane);
        ray.direction = normalize(-view.to_world.z);
    }
    return ray;
}

// A ray as wide as what it stands for: `width` m where it is, growing by `spread` m per m.
// Source: Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing",
// Ray Tracing Gems, 2019, chapter 20.
struct RayCone {
    float width;
    float spread;
};

// The cone of one of `samples` rays that share a pixel's area.
AG_FN RayCone camera_cone(CameraView view, uint samples) {
    float pixel = 2.0f * view.half_height / float(view.height) / sqrt(float(samples));
    RayCone cone;
    cone.width = view.perspective != 0u ? 0.0f : pixel;
    cone.spread = view.perspective != 0u ? pixel : 0.0f;
    return cone;
}

AG_FN RayCone advanced_cone(RayCone cone, float distance) {
    cone.width = abs(cone.width + cone.spread * distance);
    return cone;
}

// The cone after a mirror of the given curvature (1/m; convex is positive) and roughness: a turn
// of the normal turns the ray by twice as much, and a rough lobe (GGX) is 2.57 alpha wide between
// the directions where it has half its height.
AG_FN RayCone reflected_cone(RayCone cone, float curvature, float roughness) {
    cone.spread = cone.spread + 2.0f * curvature * cone.width + 2.57f * roughness * roughness;
    return cone;
}

// Mean curvature of a triangle with vertex normals along its edges, 1/m; 0 where it has no size.
AG_FN float triangle_curvature(Triangle triangle, vec3 na, vec3 nb, vec3 nc) {
    vec3 ab = triangle.b - triangle.a;
    vec3 bc = triangle.c - triangle.b;
    vec3 ca = triangle.a - triangle.c;
    float squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    if (!(squares > 0.0f)) return 0.0f;
    return (dot(nb - na, ab) + dot(nc - nb, bc) + dot(na - nc, ca)) / squares;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::CameraView) == 72);
#endif
#endif
