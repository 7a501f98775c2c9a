// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace aglow {

struct SimplifyOptions {
    float ratio = 0.02f;          ///< wanted share of the triangles, above 0, at most 1
    float max_error = kInfinity;  ///< how far the surface may move, m, as quadrics estimate it
};

struct SimplifiedMesh {
    Mesh mesh;
    size_t dense_triangles = 0, triangles = 0;
    float error = 0;  ///< estimated, m; of the primitive that moved most
};

/// The same surface in fewer triangles, by collapsing edges in the order of their quadric errors.
/// Vertices are some of those that were there, with all their attributes. Vertices that differ in
/// nothing but their normals become one, with one of these; seams of texture coordinates and
/// colours, boundaries and, where a mesh has several primitives, the edges between them are kept.
/// Creases and corners of the file are left out. A primitive whose triangles would all vanish stays
/// as it is. The count can stay above what was wanted where seams and boundaries or `max_error` do
/// not let more edges go.
/// Errors  bad_argument (a ratio outside 0..1), out_of_memory.
/// Cost    O(n log n).   Repeat  a function of its arguments alone.
/// Source  Garland & Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997,
///         as libmeshoptimizer has it.
Result<SimplifiedMesh> simplify(const Mesh& mesh, const SimplifyOptions& options);

/// A primitive whose vertex i is vertex sources[i] of `from`, with all attributes, but no triangles
/// and no tags that name vertices.
Primitive copied_vertices(const Primitive& from, std::span<const uint32_t> sources);

}  // namespace aglow
