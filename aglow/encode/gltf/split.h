// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"

namespace aglow::encode {

using namespace gltf::edit;

/// Rewrites a primitive as unwrap() left it: its vertices split as source_vertex says, its
/// triangles as a list, nothing compressed. Where nothing was split the primitive stays as it is.
/// Every attribute and morph target keeps its bits.
/// Result  for each vertex of the glTF primitive, the vertex of `primitive` it stands for.
/// Errors  malformed (data that cannot be read; a vertex that the file does not have).
Result<std::vector<uint32_t>> split_vertices(Document& document, Json& json,
                                             const Primitive& primitive);

}  // namespace aglow::encode
