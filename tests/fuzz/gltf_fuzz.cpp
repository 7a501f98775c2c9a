// SPDX-License-Identifier: Apache-2.0
// Any bytes either load or give an error, and what loads keeps the promises of Scene.
#include "aglow/scene/load.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace {

using namespace aglow;

void require(bool promise) {
    if (!promise) std::abort();
}

bool below(int index, size_t count) { return index >= -1 && index < static_cast<int>(count); }

bool finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_primitive(const Scene& scene, const Primitive& primitive) {
    const size_t count = primitive.positions.size();
    require(below(primitive.material, scene.materials.size()));
    require(primitive.normals.size() == count);
    require(primitive.colors.empty() || primitive.colors.size() == count);
    require(primitive.joints.size() == count * static_cast<size_t>(primitive.influences));
    require(primitive.weights.size() == primitive.joints.size());
    for (const auto& set : primitive.texcoords) require(set.size() == count);
    for (const auto* tag : {&primitive.sharpness, &primitive.tension, &primitive.bias})
        require(tag->empty() || tag->size() == count);
    for (const SharpEdge& crease : primitive.creases)
        require(crease.a < count && crease.b < count && crease.sharpness >= 0);
    for (const SharpVertex& corner : primitive.corners)
        require(corner.vertex < count && corner.sharpness >= 0);
    for (const uvec3 t : primitive.triangles) require(t.x < count && t.y < count && t.z < count);
    for (const vec3 p : primitive.positions) require(finite(p));
    for (const vec3 n : primitive.normals) require(std::abs(length(n) - 1) < 1e-4f);
    for (const MorphTarget& target : primitive.targets) {
        require(target.positions.empty() || target.positions.size() == count);
        require(target.normals.empty() || target.normals.size() == count);
    }
}

void check_texture(const Scene& scene, const TextureRef& reference) {
    require(below(reference.texture, scene.textures.size()));
    if (reference.texture < 0) return;
    const int image = scene.textures[static_cast<size_t>(reference.texture)].image;
    require(image >= 0 && below(image, scene.images.size()));
    const TextureImage& pixels = scene.images[static_cast<size_t>(image)];
    require(pixels.width > 0 && pixels.height > 0);
    require(pixels.rgba.size() ==
            4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
}

void check_node(const Scene& scene, const Node& node) {
    require(below(node.mesh, scene.meshes.size()) && below(node.camera, scene.cameras.size()));
    require(below(node.light, scene.lights.size()) && below(node.skin, scene.skins.size()));
    require(below(node.parent, scene.nodes.size()));
    if (node.mesh < 0 || node.skin < 0) return;
    const size_t joints = scene.skins[static_cast<size_t>(node.skin)].joints.size();
    for (const Primitive& primitive : scene.meshes[static_cast<size_t>(node.mesh)].primitives)
        for (const uint32_t joint : primitive.joints) require(joint < joints);
}

void check(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives) {
            check_primitive(scene, primitive);
            require(primitive.targets.size() == mesh.weights.size());
        }
    for (const Material& material : scene.materials) {
        require(finite(material.emission) && material.emission.x >= 0);
        check_texture(scene, material.base_color_texture);
        check_texture(scene, material.metallic_roughness_texture);
        check_texture(scene, material.emissive_texture);
    }
    for (const Node& node : scene.nodes) check_node(scene, node);
    for (const Light& light : scene.lights) require(finite(light.intensity));
    world_transforms(scene, 0.5);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it by this name.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const auto scene = load_gltf(std::as_bytes(std::span(data, size)), "fuzz.glb", {});
    if (scene) check(*scene);
    return 0;
}
