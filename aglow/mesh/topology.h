// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow {

/// The number of a vertex, edge, face or half-edge that does not exist.
inline constexpr uint32_t kNone = UINT32_MAX;

/// Sharpness from which on an edge or a vertex stays sharp at every level of subdivision.
inline constexpr float kSharp = 10;

/// Polygons by the vertices at their corners, counter-clockwise seen from the front.
struct PolygonList {
    std::vector<uint32_t> face_begin = {0};  ///< [face_count + 1] first corner; the last ends all
    std::vector<uint32_t> corners;           ///< [corner_count] vertices
    uint32_t vertex_count = 0;

    uint32_t face_count() const { return static_cast<uint32_t>(face_begin.size() - 1); }
};

/// An edge, by its ends, that subdivision keeps sharp: for `sharpness` levels, or for ever.
struct Crease {
    uint32_t a = 0, b = 0;  ///< vertices, in any order
    float sharpness = kSharp;
};

/// Who lies beside whom in a mesh of polygons: half-edges in flat arrays. Half-edge h runs along a
/// face, counter-clockwise, from corner h to the next corner, so that half-edges and corners have
/// the same numbers and those of a face follow each other.
///
/// It is a manifold: at most two faces meet at an edge, run along it in opposite directions, and
/// the faces round a vertex form one fan. source_vertex and source_face say what it was made from.
struct Topology {
    std::vector<uint32_t> face_begin = {0};  ///< [face_count + 1]
    std::vector<uint32_t> vertex;            ///< [half-edge] where it starts
    std::vector<uint32_t> twin;              ///< [half-edge] of the other face, or kNone
    std::vector<uint32_t> edge;              ///< [half-edge]
    std::vector<uint32_t> face;              ///< [half-edge]
    std::vector<uint32_t> edge_half;         ///< [edge] the lower-numbered of its half-edges
    /// [vertex] A half-edge that starts there, or kNone where no face is. Of a vertex on the
    /// boundary the one from which turning counter-clockwise, h = twin[previous(h)], meets all.
    std::vector<uint32_t> vertex_half;
    std::vector<float> edge_sharpness;    ///< [edge] 0: smooth; kSharp and above: for ever
    std::vector<float> vertex_sharpness;  ///< [vertex] likewise; 0 by default
    std::vector<uint32_t> source_vertex;  ///< [vertex] of the polygons
    std::vector<uint32_t> source_face;    ///< [face] of the polygons

    uint32_t face_count() const { return static_cast<uint32_t>(face_begin.size() - 1); }
    uint32_t half_edge_count() const { return static_cast<uint32_t>(vertex.size()); }
    uint32_t edge_count() const { return static_cast<uint32_t>(edge_half.size()); }
    uint32_t vertex_count() const { return static_cast<uint32_t>(vertex_half.size()); }
    uint32_t face_size(uint32_t f) const { return face_begin[f + 1] - face_begin[f]; }

    /// The half-edge after and before h along its face.
    uint32_t next(uint32_t h) const {
        const uint32_t f = face[h];
        return h + 1 == face_begin[f + 1] ? face_begin[f] : h + 1;
    }
    uint32_t previous(uint32_t h) const {
        const uint32_t f = face[h];
        return h == face_begin[f] ? face_begin[f + 1] - 1 : h - 1;
    }
    uint32_t end(uint32_t h) const { return vertex[next(h)]; }  ///< the vertex where h ends
    bool on_boundary(uint32_t v) const {
        return vertex_half[v] != kNone && twin[vertex_half[v]] == kNone;
    }
};

/// What had to be changed so that polygons became a manifold.
struct Repairs {
    uint32_t dropped_faces = 0;   ///< fewer than three different corners
    uint32_t cut_edges = 0;       ///< more than two faces, or faces that disagree about the front
    uint32_t split_vertices = 0;  ///< several fans met in one point: each has one of its own
    uint32_t stray_creases = 0;   ///< creases that run along no edge, left out
    bool none() const { return dropped_faces + cut_edges + split_vertices + stray_creases == 0; }
};

struct TopologyResult {
    Topology topology;
    Repairs repairs;
};

/// Finds the neighbours of all faces. The first vertices are those of `polygons`, in their order;
/// those that splitting adds come after them. A repeated corner is left out of its face. Of two
/// creases along one edge the sharper counts.
/// Shapes  at most 2^31 corners
/// Errors  bad_argument   a corner or a crease names no vertex (which), a sharpness below 0 or NaN
///         out_of_memory
/// Cost    O(n): edges are found by sorting keys.
/// Repeat  a function of its arguments alone.
Result<TopologyResult> build_topology(const PolygonList& polygons,
                                      std::span<const Crease> creases = {});

/// The same faces and half-edges over other vertices: an edge stays where its two faces agree about
/// both ends, and is a boundary elsewhere. Sharpness is that of `topology`.
/// Shapes  corners [half-edge] vertices below vertex_count. Where one of these is of several
///         corners that no edges join, each fan gets one, as build_topology() does.
/// Errors  out_of_memory.   Cost  O(n)
Result<Topology> cut_seams(const Topology& topology, std::span<const uint32_t> corners,
                           uint32_t vertex_count);

}  // namespace aglow
