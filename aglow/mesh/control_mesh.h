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
    bool quads = false;              ///< pairs of triangles that make a good quad become one
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
/// stays apart in `seams`. Faces that cover each other, as the two sides of a leaf do, are surfaces
/// of their own.
struct ControlMesh {
    /// source_face is the first triangle of a face, counted through all primitives.
    Topology topology;
    std::vector<vec3> positions;     ///< [vertex] m
    std::vector<VertexOf> vertices;  ///< [vertex] one of those that it was made of
    std::vector<VertexOf> corners;   ///< [half-edge] what the file has at the corner
    /// The same faces and corners over vertices that are also one in texture coordinates, colours
    /// and primitive: an edge across which these differ is a boundary here.
    Topology seams;
    std::vector<VertexOf> seam_vertices;   ///< [seams.vertex]
    std::vector<uint32_t> seam_to_vertex;  ///< [seams.vertex] of `topology`
    std::vector<uint32_t> face_primitive;  ///< [face]
    uint32_t quad_count = 0;               ///< pairs of triangles that became quads
    Repairs repairs;
    std::vector<std::string> warnings;  ///< `repairs` in words
};

/// Does the file have normals for it? Where it has none, loading gives flat ones.
bool has_own_normals(const Mesh& mesh);

/// Welds a mesh of a scene. Creases and corners tagged in the file (docs/formats/creases.md) are
/// kept whatever the options say.
/// Quads  The two triangles must share the diagonal with its texture coordinates and colours, be
///        nearly coplanar and have corners near 90 degrees; the best pairs are taken first. Two
///        that follow each other as exporters write a quad, (a, b, c) and (a, c, d), may be worse.
/// Errors  out_of_memory
/// Cost    O(n log n).   Repeat  a function of its arguments alone.
Result<ControlMesh> make_control_mesh(const Mesh& mesh, const ControlOptions& options = {});

}  // namespace aglow
