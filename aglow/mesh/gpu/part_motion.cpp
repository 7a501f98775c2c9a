// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/gpu/part_motion.h"

#include <algorithm>

namespace aglow::mesh::gpu {
namespace {

/// Do all keys have one value? Splines also need tangents that are zero.
bool is_constant(const AnimationChannel& channel) {
    if (channel.times.size() < 2) return true;
    const bool cubic = channel.interpolation == Interpolation::cubic_spline;
    const size_t stride = channel.values.size() / channel.times.size();
    const size_t width = cubic ? stride / 3 : stride, value_at = cubic ? width : 0;
    for (size_t key = 0; key < channel.times.size(); ++key)
        for (size_t i = 0; i < stride; ++i) {
            const bool tangent = cubic && i / width != 1;
            const float expected = tangent ? 0.0f : channel.values[value_at + i % width];
            if (channel.values[key * stride + i] != expected) return false;
        }
    return true;
}

struct Moving {
    std::vector<char> node;     ///< [node_count] its world transform changes
    std::vector<char> weights;  ///< [node_count] its morph weights change
};

Moving find_moving(const Scene& scene) {
    Moving moving{std::vector<char>(scene.nodes.size(), 0),
                  std::vector<char>(scene.nodes.size(), 0)};
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            if (channel.node < 0 || is_constant(channel)) continue;
            const auto node = static_cast<size_t>(channel.node);
            if (channel.path == Path::weights)
                moving.weights[node] = 1;
            else if (!scene.nodes[node].has_matrix)
                moving.node[node] = 1;
        }
    std::vector<size_t> open;
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        if (moving.node[n]) open.push_back(n);
    while (!open.empty()) {
        const size_t n = open.back();
        open.pop_back();
        for (const int child : scene.nodes[n].children) {
            const auto c = static_cast<size_t>(child);
            if (!moving.node[c]) open.push_back(c);
            moving.node[c] = 1;
        }
    }
    return moving;
}

const Primitive& primitive_of(const Scene& scene, const SurfacePart& part) {
    return scene.meshes[static_cast<size_t>(part.mesh)]
        .primitives[static_cast<size_t>(part.primitive)];
}

bool skin_moves(const Scene& scene, const Moving& moving, const Node& node) {
    const std::vector<int>& joints = scene.skins[static_cast<size_t>(node.skin)].joints;
    return std::any_of(joints.begin(), joints.end(),
                       [&](int joint) { return moving.node[static_cast<size_t>(joint)] != 0; });
}

PartMotion classify(const Scene& scene, const Moving& moving, const SurfacePart& part) {
    const auto n = static_cast<size_t>(part.node);
    const Node& node = scene.nodes[n];
    if (moving.weights[n] && !primitive_of(scene, part).targets.empty())
        return PartMotion::deforming;
    if (!is_skinned(scene, part)) return moving.node[n] ? PartMotion::rigid : PartMotion::still;
    // Instances of a skinned node are placed relative to it.
    const bool moves =
        skin_moves(scene, moving, node) || (moving.node[n] && !node.instances.empty());
    return moves ? PartMotion::deforming : PartMotion::still;
}

}  // namespace

bool is_skinned(const Scene& scene, const SurfacePart& part) {
    const Primitive& primitive = primitive_of(scene, part);
    return scene.nodes[static_cast<size_t>(part.node)].skin >= 0 && primitive.influences > 0 &&
           !primitive.joints.empty();
}

std::vector<PartMotion> classify_parts(const Scene& scene, std::span<const SurfacePart> parts) {
    const Moving moving = find_moving(scene);
    std::vector<PartMotion> motions;
    motions.reserve(parts.size());
    for (const SurfacePart& part : parts) motions.push_back(classify(scene, moving, part));
    return motions;
}

}  // namespace aglow::mesh::gpu
