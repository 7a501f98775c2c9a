// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/buffers.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

#include <span>
#include <string>
#include <vector>

namespace aglow::gltf {

/// All meshes as triangles, with flat normals where the file has none. Every vertex index is
/// valid, every array has one entry per vertex, all primitives of a mesh have as many morph
/// targets as the mesh has weights. What was repaired is told in `warnings`.
/// Errors  malformed (names mesh, primitive and attribute), out_of_memory.
Result<std::vector<Mesh>> read_meshes(const Json& root, std::span<const BufferView> views,
                                      Accessors& accessors, size_t material_count,
                                      std::vector<std::string>& warnings);

}  // namespace aglow::gltf
