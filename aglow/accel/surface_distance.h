// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace aglow {

/// Triangles in space.
struct TriangleSurface {
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;
};

/// The distance of each point from the nearest point of a surface, m.
/// Result  kInfinity where the surface has no triangles.
/// Errors  out_of_memory.   Cost  O(n log n) for the surface, O(log n) a point.
Result<std::vector<float>> distances(std::span<const vec3> points, const TriangleSurface& surface);

/// How far two surfaces are apart.
struct SurfaceDifference {
    double rms = 0;        ///< m; the larger of both directions'
    double hausdorff = 0;  ///< m; the largest distance met in either direction
    size_t samples = 0;    ///< points, of both surfaces together
};

/// Measured from points of either surface to the other: `samples` of equal shares of its area, for
/// the mean, and those and all vertices that triangles use, for the largest.
/// Result  zeros where neither has triangles, infinite where one of them has none.
/// Errors  out_of_memory
/// Repeat  a function of its arguments alone.
/// Source  Cignoni, Rocchini & Scopigno, "Metro: Measuring Error on Simplified Surfaces", 1998.
Result<SurfaceDifference> surface_difference(const TriangleSurface& a, const TriangleSurface& b,
                                             size_t samples);

}  // namespace aglow
