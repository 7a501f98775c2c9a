// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aglow {

struct RewrittenFiles {
    std::vector<std::filesystem::path> outputs;  ///< all files written, the scene first
    std::vector<std::string> warnings;           ///< what the new meshes could not keep
};

/// [mesh][primitive][vertex] m: of discs that stand for a primitive's triangles. Empty for one that
/// keeps them, or for all.
using SplatRadii = std::vector<std::vector<std::vector<float>>>;

/// Writes a scene whose meshes are others than those of the file it came from: OUT.glb, or OUT.gltf
/// with OUT.bin and the images it names. All that the GltfSource holds is kept, unknown extensions
/// and extras too, but for the vertices and triangles of primitives that have triangles: these are
/// the scene's, as plain accessors. KHR_draco_mesh_compression, EXT_meshopt_compression and
/// KHR_mesh_quantization go where nothing uses them any more, and so do attributes of a primitive
/// that a Scene does not hold (tangents, which readers make anew; others with a warning). Creases
/// and corners in its extras are the scene's; a displacement there has been done, so that it goes,
/// with the normal map of its material.
/// Primitives that are alike but for their material share their accessors. Nodes that the scene has
/// beyond the source's are children that show the mesh of their parent, by a matrix.
/// A primitive with `splats` becomes points, without indices and sharp tags, with the scalar
/// attribute _RADIUS.
/// A scene without source is written as write_glb() does.
///
/// Shapes  meshes, and primitives of each, as many as the source has
/// Result  All files appear together, or none is left behind.
/// Errors  bad_argument  another ending than .glb or .gltf, more than 4 GiB in a .glb, an output
///                       that would overwrite a file of the input, those of to_glb()
///         malformed     the source has data that loading did not need and that is damaged
///         unreadable    cannot write
///         out_of_memory
/// Repeat  same bytes for the same input.
Result<RewrittenFiles> rewrite_gltf(const Scene& scene, const std::filesystem::path& path,
                                    const SplatRadii& splats = {});

}  // namespace aglow
