// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"

namespace aglow::gltf::edit {

/// Adds the nodes that the scene has beyond the document's: each a child, with a matrix, of a node
/// whose mesh it shows in its place.
void add_nodes(Document& document, const Scene& scene);

}  // namespace aglow::gltf::edit
