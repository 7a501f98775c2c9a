// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/animations.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::gltf {
namespace {

Status read_inverse_bind(const Json& json, Accessors& accessors, Skin& skin) {
    AG_CHECK(accessors.charge(16 * skin.joints.size(), json.element()));
    skin.inverse_bind.assign(skin.joints.size(), mat4());
    AG_TRY(const int index, json.index("inverseBindMatrices", accessors.size(), "accessor"));
    if (index < 0) return {};
    const Accessor& accessor = accessors[index];
    if (accessor.components != 16) return json.wrong("inverseBindMatrices must be of type MAT4");
    if (accessor.count < skin.joints.size())
        return json.wrong(fmt::format("has {} inverse bind matrices for {} joints", accessor.count,
                                      skin.joints.size()));
    AG_TRY(const std::vector<float> values, accessors.floats(index));
    for (size_t joint = 0; joint < skin.joints.size(); ++joint)
        std::copy_n(values.begin() + static_cast<ptrdiff_t>(16 * joint), 16,
                    skin.inverse_bind[joint].m.begin());
    return {};
}

/// Largest joint number of a mesh, or nothing where it has no joints.
std::vector<int64_t> largest_joints(const Scene& scene) {
    std::vector<int64_t> largest;
    for (const Mesh& mesh : scene.meshes) {
        int64_t joint = -1;
        for (const Primitive& primitive : mesh.primitives)
            for (const uint32_t j : primitive.joints) joint = std::max<int64_t>(joint, j);
        largest.push_back(joint);
    }
    return largest;
}

}  // namespace

Result<size_t> count_skins(const Json& root) {
    AG_TRY(const Json list, root.array("skins"));
    return list.size();
}

Status read_skins(const Json& root, Accessors& accessors, Scene& scene) {
    AG_TRY(const std::vector<Json> list, elements(root, "skins", "skin"));
    for (const Json& json : list) {
        Skin skin;
        AG_TRY(skin.joints, json.indices("joints", scene.nodes.size(), "joint node"));
        if (skin.joints.empty()) return json.wrong("has no joints");
        AG_CHECK(read_inverse_bind(json, accessors, skin));
        scene.skins.push_back(std::move(skin));
    }
    const std::vector<int64_t> largest = largest_joints(scene);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        if (node.skin < 0 || node.mesh < 0) continue;
        const std::string element = element_name("node", i, node.name);
        const int64_t joint = largest[static_cast<size_t>(node.mesh)];
        const size_t joint_count = scene.skins[static_cast<size_t>(node.skin)].joints.size();
        if (joint >= static_cast<int64_t>(joint_count))
            return fail(Errc::malformed,
                        fmt::format("{}: mesh {} uses joint {} of skin {}, which has {}", element,
                                    node.mesh, joint, node.skin, joint_count));
        if (joint >= 0) continue;
        scene.warnings.push_back(
            fmt::format("{}: mesh {} has no joints; its skin is left out", element, node.mesh));
        node.skin = -1;
    }
    return {};
}

}  // namespace aglow::gltf
