// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"
#include "aglow/scene/rewrite_gltf.h"

namespace aglow::gltf::edit {

/// Gives every primitive of the document that has triangles the vertices and triangles of the
/// scene's, or points where it has `splats`. What cannot be kept is said in `warnings`.
/// Errors  malformed  the document has other meshes or primitives than the scene
Status replace_meshes(Document& document, const Scene& scene, const SplatRadii& splats,
                      std::vector<std::string>& warnings);

}  // namespace aglow::gltf::edit
