// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace aglow {

struct FairOptions {
    float ratio = 0.02f;          ///< wanted share of the triangles, above 0, at most 1
    float max_error = kInfinity;  ///< of the coarse surface, as a share of the mesh's diagonal
    int map_size = 0;             ///< width of the maps, texels; 0: by the dense mesh's vertices
    size_t samples = 200'000;     ///< at which either surface is compared with the other; 0: not
};

/// What became of one mesh.
struct FairMesh {
    int mesh = 0;
    size_t dense_triangles = 0, triangles = 0;
    int width = 0, height = 0;  ///< of its maps, texels
    double missed = 0;          ///< share of texels whose rays met nothing: taken from their
                                ///< neighbours
    float diagonal = 0;         ///< of the dense mesh's bounds, m
    int level = 0;              ///< of the refinement that was compared: 2^level segments per edge
    size_t refined_triangles = 0;
    double rms = 0, hausdorff = 0;  ///< m, between the refined, displaced mesh and the dense one
    /// Heights along the interpolated normals of the coarse triangles, m; the same in all channels.
    Image displacement;
};

struct FairScene {
    /// The scene with coarse meshes, made by code: it has no GltfSource. Their primitives have
    /// tangents and texture coordinates for the maps, their materials normal textures.
    Scene scene;
    std::vector<FairMesh> meshes;  ///< those that have triangles
};

/// Makes every mesh coarse, gives it texture coordinates, and bakes what it lost, by rays against
/// the dense one, into a displacement map and a tangent-space normal map, so that refining and
/// displacing gives the dense shape back: docs/formats/displacement.md says how. A mesh is taken in
/// its rest pose; skins and morph targets are kept. Materials are copied, one for each primitive;
/// normal maps that they had are left out.
///
/// Heights are those of the nearest place, in either direction, where the line along the normal
/// meets the dense surface's front; where it meets none within a tenth of the diagonal, or within
/// ten times the simplification's error, those of neighbouring texels.
/// Errors  bad_argument (options out of range, maps that cannot hold the charts), cancelled,
///         out_of_memory
/// Repeat  same bits for any number of threads.
/// Source  Cignoni et al., "A General Method for Preserving Attribute Values on Simplified Meshes",
///         IEEE Visualization 1998; Lee, Moreton & Hoppe, "Displaced Subdivision Surfaces",
///         SIGGRAPH 2000.
Result<FairScene> make_fair(Scene dense, const FairOptions& options, const Monitor& monitor = {});

/// Writes `path`, a .glb, and beside it the displacement maps, to which it sets the scene's
/// references: STEM.displacement.exr, or STEM.displacement-MESH.exr where there are several.
/// Result  the files, the scene last.
/// Errors  those of write_image() and write_glb().
Result<std::vector<std::filesystem::path>> write_fair(FairScene& fair,
                                                      const std::filesystem::path& path);

}  // namespace aglow
