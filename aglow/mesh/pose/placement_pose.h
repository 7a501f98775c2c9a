// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

#include <vector>

namespace aglow::mesh {

/// What is known of all nodes at one time: the input of every placement's pose.
struct NodePoses {
    std::vector<mat4> world;                  ///< [node_count]
    std::vector<std::vector<float>> weights;  ///< [node_count] morph weights
};
NodePoses node_poses(const Scene& scene, double time);

/// One placement of a mesh: a node in the scene, and which of its instances.
struct PlacedMesh {
    int node = 0;
    int instance = 0;
    int mesh = 0;
};
/// All placements of the active scene, in the order of nodes and instances.
std::vector<PlacedMesh> placed_meshes(const Scene& scene);

/// World transform of each joint of the placed node's skin, applied after its inverse bind matrix.
/// A skinned node has no transform of its own; its instances are placed relative to it.
std::vector<mat4> joint_transforms(const Scene& scene, const NodePoses& poses,
                                   const PlacedMesh& placed);

/// World-space vertices of one placed primitive.
struct PosedVertices {
    std::vector<vec3> positions;  ///< [vertex_count] m
    std::vector<vec3> normals;    ///< [vertex_count] unit, on the side of the file's normals
    std::vector<char> mirrored;   ///< [vertex_count] 1 where the map turns the winding round
};

/// Applies morph targets, then the skin (in place of the node's transform, glTF 2.0 section
/// 3.7.3.3) or the node and instance transforms.
PosedVertices pose_primitive(const Scene& scene, const NodePoses& poses, const PlacedMesh& placed,
                             const Primitive& primitive);

/// Positions after morph targets alone, in the mesh's own space.
std::vector<vec3> morphed_positions(const Primitive& primitive, const std::vector<float>& weights);

/// The affine map from a mesh without skin to the world.
mat4 placement_transform(const Scene& scene, const NodePoses& poses, const PlacedMesh& placed);

}  // namespace aglow::mesh
