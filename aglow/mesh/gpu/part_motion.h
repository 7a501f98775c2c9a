// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::mesh::gpu {

/// How a part of the surfaces moves over time.
enum class PartMotion : uint8_t {
    still,     ///< nothing animates it
    rigid,     ///< by its nodes' transforms alone
    deforming  ///< by a skin or morph targets
};

/// How each part moves at times >= 0. A channel whose keys all have one value moves nothing; what
/// moves a node moves all below it; a skin moves with any of its joints.
/// Shapes  [parts]
std::vector<PartMotion> classify_parts(const Scene& scene, std::span<const SurfacePart> parts);

/// Is the part drawn by its node's skin, in place of the node's transform?
bool is_skinned(const Scene& scene, const SurfacePart& part);

}  // namespace aglow::mesh::gpu
