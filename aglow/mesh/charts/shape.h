// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/soup.h"
#include "aglow/mesh/pose/placement_pose.h"

namespace aglow::mesh {

/// The shape a mesh is charted in, and how large each of its placements shows it.
struct MeshShape {
    /// Positions of all primitives, one after the other. For a mesh placed once: up to a rotation
    /// as in the world. For one placed often: under the mean metric of its placements, so that
    /// a stretch that all of them share is in the charts.
    std::vector<Point3> positions;
    std::vector<uvec3> triangles;        ///< of all primitives, indices into positions
    std::vector<size_t> first_triangle;  ///< [primitive_count + 1]
    std::vector<double> scales;          ///< [placements] world length over length here
};

/// Shape of a mesh at rest, from all of its placements (at least one).
MeshShape mesh_shape(const Scene& scene, const NodePoses& poses,
                     const std::vector<PlacedMesh>& placements);

}  // namespace aglow::mesh
