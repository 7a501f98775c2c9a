// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aglow {

struct ControlOptions {
    /// Edges whose faces meet at a larger angle are creases, radians. None: only tagged edges are.
    std::optional<float> crease_angle;
    bool crease_at_normals = false;  ///< creases where the file's normals differ across an edge
    bool quads = false;              ///< pairs of triangles that were quads become quads
};

/// A vertex of a primitive.
struct VertexOf {
    uint32_t primitive = 0;
    uint32_t vertex = 0;
    bool operator==(const VertexOf&) const = default;
};

/// A mesh of a scene as one surface: what refinement starts from. Vertices that stand in the same
/// place, in the rest pose and in every other (skin, morph targets), are one, across primitives
/// too; what differs between faces that meet there (texture coordinates, colours, the primitive)
/// stays apart in `seams`.
struct ControlMesh {
    Topology topology;
    std::vector<vec3> positions;     ///< [vertex] m
    std::vector<VertexOf> vertices;  ///< [vertex] one of those that it was made of
    /// The same faces and corners over vertices that are also one in texture coordinates and
    /// colours: an edge across which these differ is a boundary here.
    Topology seams;
    std::vector<VertexOf> seam_vertices;   ///< [seams.vertex]
    std::vector<uint32_t> seam_to_vertex;  ///< [seams.vertex] of `topology`
    std::vector<uint32_t> face_primitive;  ///< [face]
    std::vector<std::string> warnings;     ///< what was repaired, in words
};

/// Welds a mesh of a scene.
/// Errors  out_of_memory
/// Cost    O(n log n).   Repeat  a function of its arguments alone.
Result<ControlMesh> make_control_mesh(const Mesh& mesh, const ControlOptions& options = {});

}  // namespace aglow
