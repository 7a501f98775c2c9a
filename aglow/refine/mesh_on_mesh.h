// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/refine/patches.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

/// A small mesh over the coordinates of a pattern: x and y in the triangle x, y >= 0, x + y <= 1,
/// or in the unit square; z is height, in either direction.
struct ReliefMesh {
    std::vector<vec3> positions;
    std::vector<vec3> normals;  ///< [vertex], in these coordinates
    std::vector<uvec3> triangles;
};

struct ReliefOptions {
    int repeats = 1;   ///< so many of them along an edge of a face
    float height = 1;  ///< m for a z of 1
};

struct RaisedMesh {
    std::vector<vec3> positions, normals;  ///< [vertex]; normals unit
    std::vector<uint32_t> face;            ///< [vertex] it stands on
    std::vector<vec2> coordinates;         ///< [vertex] there, of its foot
    std::vector<uvec3> triangles;
};

/// Textures patches with meshes: sets `on_triangles` into every cell of a pattern on each triangle,
/// and `on_quads` likewise; one without triangles leaves its faces bare. (x, y) becomes a place on
/// the patch and z goes along its direction of displacement. On triangles every second cell has it
/// turned by half a turn.
/// Result  faces and cells that meet agree to the rounding of their evaluation.
/// Source  Porumbescu, Budge, Feng & Joy, "Shell Maps", SIGGRAPH 2005; Boubekeur & Schlick,
/// "Generic
///         Mesh Refinement on GPU", Graphics Hardware 2005.
RaisedMesh raise_mesh(const Patches& patches, const PatchControl& control,
                      const ReliefMesh& on_triangles, const ReliefMesh& on_quads,
                      const ReliefOptions& options);

}  // namespace aglow
