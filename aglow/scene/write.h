// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace aglow {

/// Writes a scene that has no GltfSource (made by code or read from OBJ) as GLB: meshes with morph
/// targets, nodes, skins, animations, materials, textures (as PNG), cameras, KHR_lights_punctual,
/// KHR_materials_emissive_strength.
/// The sky is not part of glTF and is not written. Loading the result gives the same light.
/// Errors  unreadable (cannot write), and those of to_glb().
Status write_glb(const Scene& scene, const std::filesystem::path& path);

/// The same in memory: what load_gltf() reads.
/// Errors  unsupported    the scene has instances
///         bad_argument   a primitive has no triangles, a skin no joints, a joint's number is
///         beyond
///                        65535, or a mesh's primitives differ in their number of morph targets
///                        (glTF cannot say so); or the result would exceed the 4 GiB that a GLB can
///                        hold
///         out_of_memory
/// Repeat  same bytes for the same scene.
Result<std::vector<uint8_t>> to_glb(const Scene& scene);

}  // namespace aglow
