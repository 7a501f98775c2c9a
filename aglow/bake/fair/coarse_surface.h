// SPDX-License-Identifier: Apache-2.0
// The coarse mesh whose triangles are displaced.
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/refine/displacement.h"
#include "aglow/refine/patches.h"
#include "aglow/scene/scene.h"

#include <vector>

namespace aglow::bake::fair {

/// How its triangles are refined: they stay flat, and heights go along interpolated normals.
inline constexpr PatchOptions kSurface = {PatchShape::flat, NormalField::linear};

struct CoarseSurface {
    ControlMesh control;
    std::vector<vec3> normals;     ///< [half-edge] unit
    std::vector<vec3> directions;  ///< [vertex] unit, along which heights are
    std::vector<vec2> uvs;         ///< [half-edge] of the maps
    std::vector<vec4> tangents;    ///< [half-edge]
};

/// Unwraps the mesh and adds the maps' coordinates as the next set of every primitive; normals of
/// the mesh become means of its faces', its tangents those of the maps.
/// Shapes  width and height are those of the maps, out.
/// Errors  those of unwrap() and make_control_mesh().
Result<CoarseSurface> make_coarse_surface(Mesh& mesh, int map_size, int& width, int& height);

/// The mesh refined and displaced by `heights`, 2^level segments to an edge.
/// Errors  those of Patches::create() and Tessellation::uniform().
struct RefinedSurface {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
};
Result<RefinedSurface> displaced(const CoarseSurface& surface, const HeightMap& heights, int level);

}  // namespace aglow::bake::fair
