// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"
#include "aglow/refine/displacement.h"
#include "aglow/refine/tessellation.h"
#include "aglow/shared/pn_triangle.h"
#include "aglow/shared/tagged_triangle.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

enum class PatchShape : uint8_t {
    flat,
    pn,    ///< curved PN triangles, by tags where there are any
    phong  ///< Phong tessellation
};
enum class NormalField : uint8_t { linear, quadratic };

struct PatchOptions {
    PatchShape shape = PatchShape::pn;
    NormalField normals = NormalField::quadratic;
    float phong_shape = 0.75f;  ///< 0 flat .. 1
};

/// A coarse mesh at one time.
struct PatchInput {
    std::span<const vec3> positions;  ///< [vertex]
    std::span<const vec3> normals;    ///< [half-edge] unit, of its face where it starts
    std::span<const shared::ShapeTags> tags = {};  ///< [vertex]; empty: none
};

/// What patches are evaluated from: control points of edges and faces at one time.
struct PatchControl {
    std::vector<vec3> positions;            ///< [vertex]
    std::vector<shared::EdgePoints> edges;  ///< [edge] from the end with the lower number
    std::vector<vec3> centers;              ///< [face] of triangles
    std::vector<vec3> normals;              ///< [half-edge] where it starts, of its face
    std::vector<vec3> middle_normals;       ///< [half-edge]
    std::vector<vec3> directions;           ///< [vertex] unit, along which displacement moves it
    std::vector<vec3> middle_directions;    ///< [edge]
};

/// A place on a patch.
struct PatchPlace {
    vec3 position;
    vec3 by_x, by_y;  ///< derivatives by the coordinates
    vec3 normal;      ///< unit, that it is shaded with
    vec3 direction;   ///< unit, along which displacement moves it
};

/// Curved patches over the triangles and quads of a mesh. Neighbours meet bitwise, whatever their
/// levels: points on an edge follow from data of the edge alone, in one direction.
/// Source  aglow/shared/pn_triangle.h, tagged_triangle.h, phong_tessellation.h. Quads are Coons
///         patches of the same edges.
/// Thread safety  all members, from any thread.
class Patches {
public:
    /// Errors  bad_argument  a face that is neither triangle nor quad
    static Result<Patches> create(const Topology& topology, const PatchOptions& options);

    /// Cost  O(mesh). `control` keeps its memory from frame to frame.
    void update(const PatchInput& input, PatchControl& control) const;

    /// Positions of all refined vertices, displaced if that is asked for.
    /// Shapes  positions [tessellation.vertex_count()]. The tessellation may be that of a topology
    ///         with the same faces and corners over more vertices (seams): vertices that stand on
    ///         the same place of an edge get the same bits.
    /// Cost    O(refined); of a uniform tessellation without displacement bound by memory.
    /// Repeat  same bits for any number of threads.
    void evaluate(const PatchControl& control, const Tessellation& tessellation,
                  std::span<vec3> positions) const;
    void evaluate(const PatchControl& control, const Tessellation& tessellation,
                  const DisplacementMap& displacement, std::span<vec3> positions,
                  std::span<vec3> normals) const;
    /// Unit normals. On edges and vertices those of one of the faces there: that of edge_half or
    /// vertex_half of the tessellation's topology, which is cut along creases to have both.
    void evaluate_normals(const PatchControl& control, const Tessellation& tessellation,
                          std::span<vec3> normals) const;

    /// The patch of one face at coordinates of its pattern (Pattern::coordinates), undisplaced.
    PatchPlace at(const PatchControl& control, uint32_t face, vec2 coordinates) const;

    const Topology& topology() const { return topology_; }

private:
    Patches(const Topology& topology, const PatchOptions& options)
        : topology_(topology), options_(options) {}

    Topology topology_;
    PatchOptions options_;
};

/// Normals for meshes that have none: means of the faces' round each corner, weighted by angle,
/// apart where sharp edges (Topology::edge_sharpness >= kSharp) divide the faces.
/// Shapes  positions [vertex], result [half-edge]
std::vector<vec3> corner_normals(const Topology& topology, std::span<const vec3> positions);

}  // namespace aglow
