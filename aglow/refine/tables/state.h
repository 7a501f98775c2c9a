// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/subdivision.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace aglow::refine {

/// Levels that tables take in one go: what stays in a processor's caches. What is deeper is split
/// first, step by step.
inline constexpr int kLoopLevels = 5, kCatmullClarkLevels = 4;

/// Columns of tables come in blocks of this many.
inline constexpr uint32_t kColumnBlock = 8;

/// Weights of neighbouring columns in a row, aligned for wide registers. Blocks follow each other
/// without gaps: together they are an array of floats.
struct alignas(kColumnBlock * sizeof(float)) WeightBlock {
    float weight[kColumnBlock] = {};
};
using Weights = std::vector<WeightBlock>;

inline std::span<const float> floats(const Weights& weights) {
    if (weights.empty()) return {};
    return {weights.data()->weight, weights.size() * kColumnBlock};
}
inline std::span<float> floats(Weights& weights) {
    if (weights.empty()) return {};
    return {weights.data()->weight, weights.size() * kColumnBlock};
}

/// Points as weighted sums of those of the step before: a row for each.
struct Stencils {
    std::vector<uint32_t> begin = {0};  ///< [point + 1] into both below
    std::vector<uint32_t> index;        ///< of a point of the step before
    std::vector<float> weight;

    uint32_t count() const { return static_cast<uint32_t>(begin.size() - 1); }
};

/// Where the refined points of a face are. A face of three corners uses the first three of four.
struct FaceOutput {
    uint32_t corner[4] = {};  ///< refined vertex
    /// The first of the refined vertices between corner i and i + 1. They follow each other in this
    /// direction where the face owns the edge, in the other where its neighbour does.
    uint32_t edge[4] = {};
    uint32_t interior = 0;  ///< the first of those inside
    uint32_t owned = 0;     ///< bit i: writes corner i; bit 4 + i: writes edge i
};

/// A face's refined points are its class's table times its ring: sum over rows r of
/// floats(weights)[weight_begin + r * stride + column] * point(ring[r]).
///
/// Columns: for each corner i, column i * segments is the corner, the segments - 1 after it are the
/// points along the edge to corner i + 1; then those inside in rows parallel to edge 0, the nearest
/// first, each from the side of corner 0. Then 0 up to the stride.
struct FaceTables {
    uint32_t corners = 3;              ///< of every face: 3 or 4
    uint32_t segments = 1;             ///< per edge
    uint32_t interior = 0;             ///< columns inside
    uint32_t stride = 0;               ///< floats from row to row; a multiple of kColumnBlock
    std::vector<uint32_t> rows;        ///< [class] size of the rings
    std::vector<size_t> weight_begin;  ///< [class + 1] floats
    Weights weights;                   ///< all tables, one after the other

    std::vector<uint32_t> face_class;  ///< [face]
    std::vector<size_t> ring_begin;    ///< [face + 1] into ring; rows[face_class] entries
    std::vector<uint32_t> ring;        ///< points of the last step; the corners come first
    std::vector<FaceOutput> output;    ///< [face]

    uint32_t face_count() const { return static_cast<uint32_t>(face_class.size()); }
    uint32_t class_count() const { return static_cast<uint32_t>(rows.size()); }
};

/// Tables of the same shapes and offsets as FaceTables::weights, for the limit.
struct LimitWeights {
    Weights position, tangent_u, tangent_v;  ///< normals are along u x v
};

}  // namespace aglow::refine

namespace aglow {

/// To evaluate: points = control; for each step, points = its sums of points; then every face
/// writes what it owns, and each of `loose` is copied. At level 0 all control vertices are copied,
/// and tables serve the limit alone.
struct Subdivision::State {
    SubdivisionOptions options;
    uint32_t control_count = 0;
    uint32_t vertex_count = 0;
    uint32_t refined_face_count = 0;
    /// None for Loop up to level kLoopLevels; Catmull-Clark has at least one, which makes quads.
    std::vector<refine::Stencils> steps;
    refine::FaceTables faces;
    std::vector<uint32_t> loose;  ///< control vertices that no face touches

    /// Made when first asked for.
    Result<const refine::LimitWeights*> limit() const;

    /// What the limit is made from: the mesh that the tables refine, and a face of every class.
    Topology mesh;
    std::vector<uint32_t> class_face;
    mutable std::once_flag limit_once;
    mutable Result<refine::LimitWeights> limit_weights = refine::LimitWeights{};
};

}  // namespace aglow
