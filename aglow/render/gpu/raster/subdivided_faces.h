// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/refine/creases.h"
#include "aglow/refine/subdivision.h"
#include "aglow/render/gpu/raster/control_scene.h"
#include "aglow/shared/raster_subdivision.h"

#include <cstdint>
#include <vector>

namespace aglow::render::gpu {

/// What every triangle is refined to.
struct FacePattern {
    std::vector<uint32_t> places;    ///< [vertex] RasterSubdivision::places
    std::vector<vec2> barycentrics;  ///< [vertex] subdivided as positions are: in even steps under
                                     ///< Loop's rules
    std::vector<uvec3> triangles;
    uint32_t edge_points = 0, inside = 0;  ///< vertices inside an edge, and inside the face
};

/// Errors  those of Subdivision::create()
Result<FacePattern> face_pattern(const SubdivisionOptions& options);

/// Where the refined points of a scene's faces are, in the order of Subdivision.
struct SubdividedFaces {
    std::vector<shared::RasterSubdividedFace> positions;  ///< [triangle of Surfaces]
    /// [triangle of Surfaces] Points from the subdivided control mesh's last on are those of
    /// `sides`, subdivided. Empty: as `positions`.
    std::vector<shared::RasterSubdividedFace> normals;
};

/// `sides` are those of control.topology.
SubdividedFaces subdivided_faces(const ControlScene& control, const CreaseSides& sides,
                                 const FacePattern& pattern);

}  // namespace aglow::render::gpu
