// SPDX-License-Identifier: Apache-2.0
// What engine `raster` draws patches from, in place of RasterGeometry.
#ifndef AGLOW_SHARED_RASTER_PATTERN_H
#define AGLOW_SHARED_RASTER_PATTERN_H
#include "aglow/shared/device_patch.h"
AG_NAMESPACE_BEGIN

// 40 bytes.
struct RasterPattern {
    PatchMeshPtr mesh;
    uintPtr patch_of;       // [faces of the scene] kNoTriangle: none
    PatchLevelsPtr levels;  // [patch] where every edge has a level of its own
    uintPtr steps;          // of nested_triangle_pattern() ...
    uvec3Ptr triangles;     // ... and its triangles
};
AG_BUFFER_OF(RasterPattern);

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RasterPattern) == 40);
#endif
#endif
