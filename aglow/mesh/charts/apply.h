// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/chart.h"
#include "aglow/mesh/charts/layout.h"
#include "aglow/scene/scene.h"

namespace aglow::mesh {

/// Lightmap UV of every corner of a mesh's triangles, and the chart it belongs to.
struct CornerUvs {
    std::vector<std::array<vec2, 3>> uvs;  ///< [triangle_count of the mesh]
    std::vector<int32_t> charts;           ///< [triangle_count] or -1: in none
};

/// Lays charts into their boxes; `frame` is the size in texels that becomes the unit square.
/// Triangles in no chart get the point `outside` (texels).
CornerUvs corner_uvs(size_t triangle_count, const std::vector<Chart>& charts,
                     const std::vector<PlacedBox>& boxes, Point2 frame, Point2 outside);

/// Writes lightmap UVs into the primitives of a mesh; a vertex that lies in several charts is
/// copied for each, with all attributes, and Primitive::source_vertex follows.
void apply_corner_uvs(const CornerUvs& uvs, Mesh& mesh);

}  // namespace aglow::mesh
