// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/pose/placement_pose.h"

#include "aglow/mesh/pose/morph.h"
#include "aglow/shared/pose.h"

#include <algorithm>

namespace aglow::mesh {
namespace {

mat4 instance_transform(const Node& node, int instance) {
    return node.instances.empty() ? mat4{} : node.instances[static_cast<size_t>(instance)];
}

/// Adds weight * displacement for every target; `pick` chooses positions or normals.
template <class Pick>
void add_targets(std::vector<vec3>& values, const Primitive& primitive,
                 const std::vector<float>& weights, Pick pick) {
    const size_t count = std::min(weights.size(), primitive.targets.size());
    for (size_t t = 0; t < count; ++t) {
        const std::vector<vec3>& displacements = pick(primitive.targets[t]);
        if (weights[t] == 0 || displacements.empty()) continue;
        for (size_t v = 0; v < values.size(); ++v) values[v] += displacements[v] * weights[t];
    }
}

shared::Affine affine(const mat4& t) {
    const auto column = [&](int i) { return vec3{t.at(0, i), t.at(1, i), t.at(2, i)}; };
    return {column(0), column(1), column(2), column(3)};
}

/// Linear blend of the joints that move vertex v. Weights are divided by their sum, since files
/// with 8-bit weights miss 1 by a little; a vertex without any weight follows its first joint.
shared::Affine blend_joints(const std::vector<shared::Affine>& joints, const Primitive& primitive,
                            size_t v) {
    const auto influences = static_cast<size_t>(primitive.influences);
    const uint32_t* joint = &primitive.joints[v * influences];
    const float* weight = &primitive.weights[v * influences];
    float sum = 0;
    for (size_t i = 0; i < influences; ++i) sum += weight[i];
    if (!(sum > 0)) return joints[joint[0]];
    shared::Affine blend = shared::affine_zero();
    for (size_t i = 0; i < influences; ++i)
        if (weight[i] != 0) blend = shared::add_joint(blend, joints[joint[i]], weight[i] / sum);
    return blend;
}

void place_vertex(PosedVertices& posed, size_t v, const shared::Affine& transform) {
    const shared::PosedVertex vertex =
        shared::place_vertex(transform, posed.positions[v], posed.normals[v]);
    posed.positions[v] = vertex.position;
    posed.normals[v] = vertex.normal;
    posed.mirrored[v] = static_cast<char>(vertex.mirrored);
}

}  // namespace

NodePoses node_poses(const Scene& scene, double time) {
    return {world_transforms(scene, time), morph_weights(scene, time)};
}

std::vector<PlacedMesh> placed_meshes(const Scene& scene) {
    std::vector<PlacedMesh> placed;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.in_scene || node.mesh < 0) continue;
        const size_t count = std::max<size_t>(1, node.instances.size());
        for (size_t i = 0; i < count; ++i)
            placed.push_back({static_cast<int>(n), static_cast<int>(i), node.mesh});
    }
    return placed;
}

std::vector<vec3> morphed_positions(const Primitive& primitive, const std::vector<float>& weights) {
    std::vector<vec3> positions = primitive.positions;
    add_targets(positions, primitive, weights,
                [](const MorphTarget& t) -> const std::vector<vec3>& { return t.positions; });
    return positions;
}

mat4 placement_transform(const Scene& scene, const NodePoses& poses, const PlacedMesh& placed) {
    const auto n = static_cast<size_t>(placed.node);
    return poses.world[n] * instance_transform(scene.nodes[n], placed.instance);
}

std::vector<mat4> joint_transforms(const Scene& scene, const NodePoses& poses,
                                   const PlacedMesh& placed) {
    const Node& node = scene.nodes[static_cast<size_t>(placed.node)];
    const Skin& skin = scene.skins[static_cast<size_t>(node.skin)];
    mat4 instance;
    if (!node.instances.empty()) {
        const mat4& world = poses.world[static_cast<size_t>(placed.node)];
        instance = world * instance_transform(node, placed.instance) * inverse_affine(world);
    }
    std::vector<mat4> joints(skin.joints.size());
    for (size_t j = 0; j < joints.size(); ++j) {
        joints[j] = instance * poses.world[static_cast<size_t>(skin.joints[j])];
        if (j < skin.inverse_bind.size()) joints[j] = joints[j] * skin.inverse_bind[j];
    }
    return joints;
}

PosedVertices pose_primitive(const Scene& scene, const NodePoses& poses, const PlacedMesh& placed,
                             const Primitive& primitive) {
    const Node& node = scene.nodes[static_cast<size_t>(placed.node)];
    const std::vector<float>& weights = poses.weights[static_cast<size_t>(placed.node)];
    const size_t vertex_count = primitive.positions.size();
    PosedVertices posed{morphed_positions(primitive, weights), primitive.normals,
                        std::vector<char>(vertex_count, 0)};
    posed.normals.resize(vertex_count, vec3{0, 0, 0});
    add_targets(posed.normals, primitive, weights,
                [](const MorphTarget& t) -> const std::vector<vec3>& { return t.normals; });

    if (node.skin >= 0 && primitive.influences > 0 && !primitive.joints.empty()) {
        std::vector<shared::Affine> joints;
        for (const mat4& joint : joint_transforms(scene, poses, placed))
            joints.push_back(affine(joint));
        for (size_t v = 0; v < vertex_count; ++v)
            place_vertex(posed, v, blend_joints(joints, primitive, v));
        return posed;
    }
    const shared::Affine transform = affine(placement_transform(scene, poses, placed));
    for (size_t v = 0; v < vertex_count; ++v) place_vertex(posed, v, transform);
    return posed;
}

}  // namespace aglow::mesh
