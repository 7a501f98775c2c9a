// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <vector>

namespace aglow {

struct UnwrapOptions {
    /// Wanted edge length of a texel, m; 0: as fine as `resolution` allows.
    float texel_size = 0;
    /// Width of the atlas in texels where texel_size is 0. It is no higher than wide, unless the
    /// charts are so many that one texel for each needs more rows.
    int resolution = 1024;
    int max_resolution = 16384;  ///< width and height the atlas may reach
    int gutter = 2;              ///< free texels between any two charts and at the border
};

/// Where the lightmap UVs of one placed mesh lie in the atlas: texel = offset + scale * uv.
struct Placement {
    int node = 0;
    int instance = 0;
    int mesh = 0;
    vec2 scale = {0, 0};   ///< texels
    vec2 offset = {0, 0};  ///< texels
};

enum class UvOrigin : uint8_t { file, charts };

/// The lightmap's floor plan.
struct Atlas {
    int width = 0, height = 0;          ///< texels
    float texel_size = 0;               ///< m, the larger side of a texel on the surface
    std::vector<Placement> placements;  ///< [placed meshes], in the order of nodes and instances
    std::vector<UvOrigin> origins;      ///< [mesh] where its lightmap UVs come from
    int chart_count = 0;                ///< of all meshes, made or found
};

/// Gives every mesh of the active scene lightmap UVs (Primitive::lightmap_uvs) and every placed
/// instance its own part of one atlas.
///
/// A mesh keeps its TEXCOORD_1 where that is valid: in range, no overlap, no triangle without area.
/// Otherwise its triangles are segmented into charts whose normals stay within a bound,
/// parameterised with low stretch, and packed with gutters. Vertices on chart borders are split;
/// Primitive::source_vertex says where each came from. No triangle is lost; those whose corners
/// coincide get a point in the gutter. Texel density is uniform over the world: it follows each
/// instance's scale. Charts are fitted to whole texels (at most 2 % off in length); one narrower
/// than a texel is widened to it. Where rows of an atlas of given resolution would be left over,
/// texels are made up to 1.4 times finer along v. Meshes that no node of the scene places are left
/// as they are.
///
/// Errors  bad_argument  a texel size or resolution that cannot hold the charts even at the
///                       largest size allowed; says which size would do.
/// Cost    O(n log n) in triangles plus the packing.
/// Repeat  same bits for any thread count.
/// Source  Levy et al., "Least Squares Conformal Maps", SIGGRAPH 2002 (where charts are not flat).
Result<Atlas> unwrap(Scene& scene, const UnwrapOptions& options, const Monitor& monitor = {});

}  // namespace aglow
