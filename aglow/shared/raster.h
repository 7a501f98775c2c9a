// SPDX-License-Identifier: Apache-2.0
// What the shaders of engine `raster` read beside the scene.
#ifndef AGLOW_SHARED_RASTER_H
#define AGLOW_SHARED_RASTER_H
#include "aglow/shared/device_scene.h"
#include "aglow/shared/form_factor.h"
AG_NAMESPACE_BEGIN

// The triangles ("faces") of the scene as they are. 24 bytes.
struct RasterGeometry {
    vec3Ptr positions;   // [vertices] world space
    vec3Ptr normals;     // [vertices] unit
    uvec3Ptr triangles;  // [faces]
};
AG_BUFFER_OF(RasterGeometry);

// An emissive triangle that stands for itself, or for several. 20 bytes.
struct RasterEmitter {
    uint triangle;
    vec3 luminance;  // cd/m^2, times the emissive area that it stands for over its own
    uint both_sides;
};
AG_BUFFER_OF(RasterEmitter);

AG_CONST uint kSkyTerms = 9u;

// A frame's camera and light.
struct RasterFrame {
    CameraView view;
    vec4 clip_x, clip_y, clip_z, clip_w;  // clip coordinates: dot(row, (p - eye, 1))
    vec3 sky[9];                          // see sky_irradiance()
    float most_luminance;                 // that the image can hold, cd/m^2
    uint baked;                           // 1: E is in the lightmap
    uint emitter_count;
    RasterEmitterPtr emitters;
};
AG_BUFFER_OF(RasterFrame);

// Push constants of all that draws surfaces.
struct RasterArgs {
    uint first_group;  // of a mesh shader
    uint ordered;      // 1: faces are drawn in the order of `order`, 0: by their numbers
    DeviceScenePtr scene;
    RasterFramePtr frame;
    RasterGeometryPtr geometry;
    uintPtr order;                // faces
    uint first_face, face_count;  // places in it, or faces, that a mesh shader draws
    uint segments;                // of a pattern
    uint unused;
};

// Term i < 9 of the real spherical harmonics up to degree 2.
AG_FN float harmonic(uint i, vec3 d) {
    if (i == 0u) return 0.282094792f;
    if (i == 1u) return 0.488602512f * d.y;
    if (i == 2u) return 0.488602512f * d.z;
    if (i == 3u) return 0.488602512f * d.x;
    if (i == 4u) return 1.09254843f * d.x * d.y;
    if (i == 5u) return 1.09254843f * d.y * d.z;
    if (i == 6u) return 0.315391565f * (3.0f * d.z * d.z - 1.0f);
    if (i == 7u) return 1.09254843f * d.x * d.z;
    return 0.546274215f * (d.x * d.x - d.y * d.y);
}

// By what a cosine lobe weighs the terms of i's degree.
AG_FN float cosine_term(uint i) {
    return i == 0u ? 3.14159265f : i < 4u ? 2.09439510f : 0.785398163f;
}

// Irradiance of a sky that nothing hides on a plane with normal n, lux. Within 1 % of the truth for
// skies without a sun, as all but the first 9 terms of a sky matter little once a cosine has
// weighed them.
// Source: Ramamoorthi & Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
// SIGGRAPH 2001.
AG_FN vec3 sky_irradiance(RasterFrame frame, vec3 n) {
    vec3 sum = frame.sky[0] * harmonic(0u, n);
    for (uint i = 1u; i < kSkyTerms; ++i) sum = sum + frame.sky[i] * harmonic(i, n);
    vec3 none = sum * 0.0f;
    return max(sum, none);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RasterGeometry) == 24);
static_assert(sizeof(aglow::shared::RasterEmitter) == 20);
static_assert(sizeof(aglow::shared::RasterFrame) == 264);
static_assert(sizeof(aglow::shared::RasterArgs) == 56);
#endif
#endif
