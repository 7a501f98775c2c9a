// SPDX-License-Identifier: Apache-2.0
// A scene to be drawn as shaders find it: addresses of its arrays. Triangles and vertices are in
// one pose; triangles lie in the order of the groups that move alike.
#ifndef AGLOW_SHARED_DEVICE_SCENE_H
#define AGLOW_SHARED_DEVICE_SCENE_H
#include "aglow/shared/camera.h"
#include "aglow/shared/light.h"
#include "aglow/shared/shading.h"
#include "aglow/shared/sky.h"
AG_NAMESPACE_BEGIN

struct DeviceScene {
    TrianglePtr corners;   // [triangle_count] world space
    vec3Ptr normals;       // [vertex_count] unit
    uvec3Ptr triangles;    // [triangle_count]
    uintPtr source_of;     // [triangle_count] the triangle of Surfaces
    uintPtr material_of;   // [triangle_count] index into materials
    vec2Ptr texcoords;     // [texcoord_sets][vertex_count]
    vec4Ptr colors;        // [vertex_count]; none where has_colors is 0
    vec2Ptr lightmap_uvs;  // [vertex_count] in texels; none where lightmap_width is 0
    SurfaceMaterialPtr materials;
    TextureLevelsPtr textures;
    uintPtr texels;      // RGBA8 of all textures and levels
    floatPtr from_srgb;  // [256] linear values of sRGB-coded bytes
    vec3Ptr lightmap;    // [lightmap_height][lightmap_width] lux
    PunctualLightPtr lights;
    floatPtr photometry;    // see PunctualLight
    uintPtr emitters;       // [emitter_count] emissive triangles
    floatPtr emitter_sums;  // [emitter_count] ascending to 1: see sample_emitter()
    vec3Ptr sky;            // [sky_height][sky_width] cd/m^2
    floatPtr sky_rows;      // [sky_height] ascending to 1: in which row light comes from
    floatPtr sky_cells;     // [sky_height][sky_width] ascending to 1 in each row
    uint vertex_count;
    uint texcoord_sets;
    uint has_colors;
    uint light_count;
    uint emitter_count;
    int lightmap_width, lightmap_height;
    int sky_width, sky_height;  // 0: no image
    uint sky_sampled;           // 1: sky_rows and sky_cells are there
    vec3 sky_luminance;         // cd/m^2; multiplies the image
};
AG_BUFFER_OF(DeviceScene);

AG_NAMESPACE_END
#endif
