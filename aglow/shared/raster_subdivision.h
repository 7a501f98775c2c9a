// SPDX-License-Identifier: Apache-2.0
// What engine `raster` draws subdivided surfaces from, in place of RasterGeometry.
#ifndef AGLOW_SHARED_RASTER_SUBDIVISION_H
#define AGLOW_SHARED_RASTER_SUBDIVISION_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kSubdividedInside = 6u;  // in RasterSubdividedFace.first
AG_CONST uint kSubdividedPlaces = 7u;
AG_CONST uint kPlaceBits = 3u;  // that say which of these a place is at; those above say how far

// Where the refined points of a face are. 32 bytes.
struct RasterSubdividedFace {
    uint first[7];  // of its corners (1 each), of its edges, of those inside; kNoTriangle: no face
    uint reversed;  // bit i: points of first[i] run against the face
};
AG_BUFFER_OF(RasterSubdividedFace);

// 56 bytes.
struct RasterSubdivision {
    vec3Ptr positions;                     // [points] world space
    vec3Ptr normals;                       // [points, then those on creases] unit
    RasterSubdividedFacePtr faces;         // [faces of the scene] their positions
    RasterSubdividedFacePtr normal_faces;  // likewise their normals
    uintPtr places;                        // [vertices of a face] which point each is
    vec2Ptr barycentrics;                  // [vertices of a face] where they are on it
    uint edge_points;                      // inside an edge
    uint unused;
};
AG_BUFFER_OF(RasterSubdivision);

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RasterSubdividedFace) == 32);
static_assert(sizeof(aglow::shared::RasterSubdivision) == 56);
#endif
#endif
