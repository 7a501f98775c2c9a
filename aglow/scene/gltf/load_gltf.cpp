// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/animations.h"
#include "aglow/scene/gltf/buffers.h"
#include "aglow/scene/gltf/cameras_lights.h"
#include "aglow/scene/gltf/container.h"
#include "aglow/scene/gltf/extensions.h"
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/gltf/materials.h"
#include "aglow/scene/gltf/meshes.h"
#include "aglow/scene/gltf/nodes.h"
#include "aglow/scene/gltf/textures.h"
#include "aglow/scene/gltf_source.h"
#include "aglow/scene/load.h"

#include <new>

namespace aglow {
namespace {

/// Reads everything in the order in which parts refer to each other.
Result<Scene> read_scene(const gltf::Container& file, GltfSource& source) {
    AG_TRY(const gltf::JsonDocument document, gltf::JsonDocument::parse(file.json));
    const gltf::Json root = document.root();
    Scene scene;
    AG_CHECK(gltf::check_requirements(root, scene.warnings));
    AG_TRY(source.buffers, gltf::read_buffers(root, file.binary, source.folder));
    AG_TRY(const auto views, gltf::read_buffer_views(root, source.buffers));
    size_t file_bytes = file.json.size();
    for (const auto& buffer : source.buffers) file_bytes += buffer.size();
    AG_TRY(auto accessors, gltf::Accessors::read(root, views, file_bytes));

    AG_TRY(auto images, gltf::read_images(root, views, source.folder));
    AG_TRY(scene.textures, gltf::read_textures(root, images));
    AG_TRY(scene.materials, gltf::read_materials(root, scene.textures, scene.warnings));
    AG_TRY(scene.images, gltf::decode_used_images(images, scene.textures, scene.materials));
    source.images = std::move(images.files);
    gltf::warn_of_reflectance(scene);
    AG_TRY(scene.meshes,
           gltf::read_meshes(root, views, accessors, scene.materials.size(), scene.warnings));
    AG_TRY(scene.cameras, gltf::read_cameras(root));
    AG_TRY(scene.lights, gltf::read_lights(root));
    AG_TRY(const size_t skin_count, gltf::count_skins(root));
    AG_TRY(gltf::LightProfiles profiles, gltf::read_light_profiles(root, views, source.folder));
    AG_CHECK(gltf::read_nodes(root, accessors, skin_count, profiles, scene));
    source.light_profiles = std::move(profiles.files);
    AG_CHECK(gltf::read_skins(root, accessors, scene));
    AG_CHECK(gltf::read_animations(root, accessors, scene));
    AG_CHECK(gltf::check_extent(scene));
    return scene;
}

Result<Scene> load_container(std::span<const uint8_t> bytes, const std::filesystem::path& folder) {
    AG_TRY(gltf::Container file, gltf::split(bytes));
    auto source = std::make_shared<GltfSource>();
    source->folder = folder;
    AG_TRY(Scene scene, read_scene(file, *source));
    source->json = std::move(file.json);
    scene.source = std::move(source);
    return scene;
}

}  // namespace

Result<Scene> load_gltf(std::span<const std::byte> bytes, const std::string& name,
                        const std::filesystem::path& folder) {
    try {
        const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
        auto scene = load_container({data, bytes.size()}, folder);
        if (!scene) return fail(scene.error().code, scene.error().message, name);
        scene->name = name;
        return scene;
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "there is no memory for this scene", name);
    }
}

}  // namespace aglow
