// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/shared/tagged_triangle.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace aglow::render::gpu {

/// A placement of a mesh that names a height map.
struct DisplacedPlacement {
    DisplacementRef source;
    uint32_t part = 0;  ///< one of its in Surfaces
    /// By how much longer than in the mesh lengths are in the rest pose.
    float scale = 1;
};

/// All meshes of a scene where they are placed, as one coarse surface to refine: meshes are welded
/// each for itself, and their placements do not touch. Corners of boundaries are sharp, as
/// with_corners() has them.
struct ControlScene {
    Topology topology;
    std::vector<uint32_t> vertex_source;  ///< [vertex] of Surfaces
    std::vector<uint32_t> corner_source;  ///< [half-edge] vertex of Surfaces
    std::vector<uint32_t> patch_of;       ///< [triangle of Surfaces] its face here; kNone: none
    std::vector<shared::ShapeTags> tags;  ///< [vertex]; empty: no primitive has any
    std::vector<bool> lacks_normals;      ///< [face] smooth ones take the place of the file's
    std::vector<DisplacedPlacement> displaced;
    std::vector<uint32_t> kind_of;  ///< [vertex] 1 + its place in `displaced`; 0: not displaced
    std::vector<vec2> uvs;          ///< [half-edge] in the height map
};

/// Faces have the corners of their triangle in `rest`, in its order: mirrored placements are turned
/// about. Normals are lacking where the file has none, or everywhere if a crease angle is given.
/// Errors  unsupported (primitives of one mesh name several height maps), out_of_memory.
Result<ControlScene> control_scene(const Scene& scene, const Surfaces& rest,
                                   std::optional<float> crease_angle = std::nullopt);

}  // namespace aglow::render::gpu
