// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/shape.h"
#include "aglow/mesh/raster/polygon.h"

#include <optional>

namespace aglow::mesh {

/// A mesh's own second UV set, found fit for light.
struct FileUvs {
    Point2 low, high;        ///< box of the UVs in use
    Point2 meters_per_unit;  ///< surface length per unit of u and of v, area true
    int chart_count = 0;     ///< connected regions
};

/// TEXCOORD_1 of all primitives together, where every UV in use is finite and in the unit square,
/// no two triangles overlap, and every triangle of some area has some in UV space.
std::optional<FileUvs> valid_file_uvs(const Mesh& mesh, const MeshShape& shape, const Soup& soup);

}  // namespace aglow::mesh
