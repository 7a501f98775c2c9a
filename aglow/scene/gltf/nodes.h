// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/cameras_lights.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/scene.h"

namespace aglow::gltf {

/// Reads the nodes into `scene`, whose meshes, cameras and lights are read already, links them to
/// trees, and marks those that the active scene shows at its finest level of detail. The skins of
/// nodes are checked to be below `skin_count`.
/// Errors  malformed (names the node), out_of_memory.
Status read_nodes(const Json& root, Accessors& accessors, size_t skin_count,
                  const LightProfiles& profiles, Scene& scene);

/// Checks that the rest pose keeps every mesh, camera and light at finite coordinates, small
/// enough that areas and squared distances of its triangles are finite too.
/// Errors  malformed, unsupported (beyond 1e9 m); names the node.
Status check_extent(const Scene& scene);

}  // namespace aglow::gltf
