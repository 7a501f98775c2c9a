// SPDX-License-Identifier: Apache-2.0
// Meshes of a scene that need to be refined only once.
#pragma once
#include "aglow/scene/scene.h"

#include <cstdint>
#include <vector>

namespace aglow::refine {

/// What makes a mesh of another one.
struct Likeness {
    size_t mesh = 0;     ///< that it is like; itself if there is none before it
    bool moved = false;  ///< else it is the same, but for its materials
    mat4 motion;         ///< turns and moves the other onto this one
};

enum class Motions : uint8_t { none, rigid };

/// Finds, for each mesh, the first one that it is like: with the same triangles over the same
/// vertices in the same order, alike in everything but materials. With rigid motions positions and
/// normals may be turned and moved, within four roundings of the largest coordinate, if the mesh is
/// closed (moved, an open one does not meet another bitwise), has neither skin nor morph targets,
/// and no node instances it.
/// Shapes  result [mesh]
/// Cost    O(n), and that of comparing those with as many triangles and vertices
std::vector<Likeness> find_alike(const Scene& scene, Motions motions);

/// Shows moved meshes through a child node with the motion, in place of the nodes that have them.
void place_moved(Scene& scene, const std::vector<Likeness>& alike);

}  // namespace aglow::refine
