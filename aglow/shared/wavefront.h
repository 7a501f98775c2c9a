// SPDX-License-Identifier: Apache-2.0
// What the passes of the wavefront renderer hand to each other. A wavefront is a set of paths, one
// per camera ray, that go from pass to pass together; passes work on those that a queue names, in
// the order of the paths, so that pictures repeat bit by bit.
//
// Source: Laine, Karras & Aila, "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs",
// High Performance Graphics 2013.
#ifndef AGLOW_SHARED_WAVEFRONT_H
#define AGLOW_SHARED_WAVEFRONT_H
#include "aglow/shared/device_scene.h"
#include "aglow/shared/structure.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kWavefrontGroupSize = 64u;
// Shadow rays of one path that are in flight together.
AG_CONST uint kShadowSlots = 4u;

// What a camera ray brings to its pixel.
struct WavefrontPath {
    vec3 luminance;  // found so far, cd/m^2
    vec3 weight;     // share of what its next ray finds that arrives
    RayCone cone;    // of the next ray where it starts
};
AG_BUFFER_OF(WavefrontPath);

// A surface that a path has met, and the light found to reach it.
struct WavefrontSurface {
    vec3 position;
    vec3 normal, geometric_normal;   // unit, towards the front; the first interpolated
    vec3 front_origin, back_origin;  // where rays to lights start
    float magnitude;                 // of the triangle's coordinates
    uint front;                      // 1: the viewer is on that side
    uint glossy;                     // 1: shows highlights
    vec3 to_viewer;                  // unit
    vec3 f0;                         // reflectance at normal incidence
    float alpha;                     // width of the lobe of highlights
    SurfaceLook look;
    RayCone mirrored;  // cone of the mirror ray
    vec3 irradiance;   // lux: from the lightmap, or from the sky and emissive triangles
    vec3 punctual;     // lux: from lights without extent
    vec3 highlights;   // their reflections, cd/m^2
};
AG_BUFFER_OF(WavefrontSurface);

// Light that arrives unless something stands in its way.
struct WavefrontShadow {
    vec3 irradiance;  // lux
    vec3 highlight;   // its reflection, cd/m^2
};
AG_BUFFER_OF(WavefrontShadow);

// Rays traced, in two words: the low one first.
struct RayCounts {
    uvec2 camera, mirror, shadow;
};
AG_BUFFER_OF(RayCounts);

// The arrays of a wavefront of `capacity` paths.
struct Wavefront {
    WavefrontPathPtr paths;        // [capacity]
    RayQueryPtr rays;              // [capacity]
    RayHitPtr hits;                // [capacity]
    uintPtr alive;                 // [capacity] 1: its ray is to be traced
    uintPtr queue;                 // [capacity] the paths that are alive
    uintPtr queued;                // their number
    WavefrontSurfacePtr surfaces;  // [capacity]
    uintPtr lit;                   // [capacity] 1: has met a surface that light can reach
    uintPtr lit_queue;             // [capacity] the paths that have
    uintPtr lit_queued;            // their number
    // [kShadowSlots][WavefrontArgs::alive_count] in the order of lit_queue:
    WavefrontShadowPtr shadows;
    RayQueryPtr shadow_rays;
    uintPtr shadow_alive;   // 1: its ray is to be traced
    uintPtr shadow_queue;   // those that are to be
    uintPtr shadow_queued;  // their number
    floatPtr visibility;    // share of the light that passes
};
AG_BUFFER_OF(Wavefront);

AG_CONST uint kStoredNothing = 0u;
AG_CONST uint kStoredResting = 1u;  // all but the direct light of lights without extent
AG_CONST uint kStoredAll = 2u;

// What a frame is drawn with.
struct FrameSettings {
    CameraView view;
    uint samples;      // rays per pixel
    uint seed;         // of draw_seed()
    uint reflections;  // mirror rays that follow each other, at most; 0: matte
    uint highlight;    // kHighlight...
    uint stored;       // kStored...: light that the lightmap holds
    uint unused;
    vec2Ptr offsets;  // [samples] of the rays from the middle of a pixel
    vec3Ptr image;    // [height][width] sums, in the end means, cd/m^2
    RayCountsPtr counts;
};
AG_BUFFER_OF(FrameSettings);

// Push constants of all passes.
struct WavefrontArgs {
    uint first_group;
    uint path_count;   // in flight: pixel_count times samples
    uint alive_count;  // as many as there are alive, or more
    uint unused;
    WavefrontPtr wavefront;
    DeviceScenePtr scene;
    TraceScenePtr structure;
    FrameSettingsPtr frame;
    uint first_pixel;  // of the tile, in the order of tile_pixel()
    uint pixel_count;
    uint first_sample;
    uint depth;  // of reflection
    uint first_light;
    uint light_count;  // of this pass, up to kShadowSlots
};

// The pixel at place `index` of the order in which pixels are worked on: row by row of blocks of
// 8 x 8, along Morton's curve in each, so that rays that run together lie together. Some lie
// outside of the image.
AG_FN uvec2 tile_pixel(uint index, uint width) {
    uint blocks = (width + 7u) / 8u;
    uint block = index / 64u;
    uvec2 pixel;
    pixel.x = (block % blocks) * 8u + (index & 1u) + ((index >> 1u) & 2u) + ((index >> 2u) & 4u);
    pixel.y =
        (block / blocks) * 8u + ((index >> 1u) & 1u) + ((index >> 2u) & 2u) + ((index >> 3u) & 4u);
    return pixel;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::WavefrontArgs) == 72);
static_assert(sizeof(aglow::shared::WavefrontPath) == 32);
#endif
#endif
