// SPDX-License-Identifier: Apache-2.0
// What engine `raster` draws patches from, in place of RasterGeometry.
#ifndef AGLOW_SHARED_RASTER_PATTERN_H
#define AGLOW_SHARED_RASTER_PATTERN_H
#include "aglow/shared/device_patch.h"
AG_NAMESPACE_BEGIN

// 32 bytes.
struct RasterPattern {
    PatchMeshPtr mesh;
    uintPtr patch_of;  // [faces of the scene] kNoTriangle: none
    uintPtr steps;     // Pattern::steps
    uint segments;
    uint unused;
};
AG_BUFFER_OF(RasterPattern);

// Likewise where every edge has a level of its own. 32 bytes.
struct RasterAdaptive {
    PatchMeshPtr mesh;
    uintPtr patch_of;       // as above
    PatchLevelsPtr levels;  // [patch]
    uintPtr steps;          // of nested_triangle_pattern()
};
AG_BUFFER_OF(RasterAdaptive);

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RasterPattern) == 32);
static_assert(sizeof(aglow::shared::RasterAdaptive) == 32);
#endif
#endif
