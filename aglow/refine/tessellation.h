// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

/// The vertices and triangles of a mesh all of whose faces are refined by patterns, without their
/// places. Vertices on an edge are those of the edge, once: faces of different levels meet in the
/// same ones.
///
/// Refined vertices come in the order of Subdivision: those of the mesh; those on every edge, from
/// the start of edge_half to its end; those inside each face, in the order of its pattern.
struct Tessellation {
    /// All edges have `segments`.
    /// Errors  bad_argument  segments outside 1..kMostSegments, a face of more than four corners,
    ///                       more than 2^31 refined vertices
    static Result<Tessellation> uniform(const Topology& topology, int segments);

    /// Every edge has a level of its own, 1..kMostAdaptiveSegments; faces have the pattern of their
    /// finest edge. Discrete levels are numbers of segments, rounded up; continuous ones refine by
    /// powers of two, between which vertices move: see aglow/shared/pattern.h.
    /// Shapes  levels [edge_count]
    enum class Levels : uint8_t { discrete, continuous };
    static Result<Tessellation> adaptive(const Topology& topology, std::span<const float> levels,
                                         Levels kind = Levels::discrete);

    uint32_t vertex_count() const { return face_first.back(); }

    std::vector<uvec3> triangles;               ///< counter-clockwise, face after face
    std::vector<uint32_t> face_triangle = {0};  ///< [face + 1] first triangle of it

    Levels levels = Levels::discrete;
    int segments = 0;  ///< of all faces and edges; 0: adaptive
    std::vector<uint32_t>
        edge_first;  ///< [edge + 1] first vertex inside it; the last: inside face 0
    std::vector<uint32_t> face_first;     ///< [face + 1] first vertex inside it
    std::vector<float> edge_level;        ///< [edge]
    std::vector<uint16_t> face_segments;  ///< [face] of its pattern
    std::vector<float> face_inner;        ///< [face] PatchLevels::inner

    /// Irregular patterns: vertices of triangles are drawn towards corners of greater density (of
    /// curvature, or nearness to a viewer), > 0, [vertex] of the mesh that patches are made from.
    /// Empty: even. Edges follow from their own ends, so that nothing opens; quads stay even
    /// inside.
    std::vector<float> density;

    // Of the topology.
    std::vector<uint32_t> vertex_half;  ///< [vertex]
    std::vector<uint32_t> edge_half;    ///< [edge]
    std::vector<uint32_t> edge;         ///< [half-edge]
};

/// For a mesh cut open along seams of attributes: which refined vertex of `whole` each of `cut`
/// stands on. Both were made with the same levels, `cut` from the same faces and corners over more
/// vertices.
/// Shapes  result [cut.vertex_count()]
std::vector<uint32_t> refined_sources(const Topology& cut_topology, const Tessellation& cut,
                                      const Topology& whole_topology, const Tessellation& whole);

}  // namespace aglow
