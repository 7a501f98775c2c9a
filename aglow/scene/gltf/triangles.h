// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::gltf {

/// Triangles of a primitive mode (4 list, 5 strip, 6 fan) over its index list; none for points
/// and lines. Corners left over are dropped, as the specification says.
/// Source  glTF 2.0 specification, section 3.7.2.1.
std::vector<uvec3> triangles_of(int mode, std::span<const uint32_t> indices);

/// Gives every triangle three vertices of its own with its geometric normal: what glTF asks of
/// primitives without normals. All attributes follow; source_vertex tells where they came from.
void make_flat(Primitive& primitive);

/// Makes normals unit length. Those without a direction become the mean of the triangles around
/// the vertex. Result: how many had none.
size_t repair_normals(Primitive& primitive);

}  // namespace aglow::gltf
