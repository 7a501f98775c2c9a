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

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RasterPattern) == 32);
#endif
#endif
