// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/obj/materials.h"

#include "aglow/core/file.h"
#include "aglow/core/text.h"
#include "aglow/scene/gltf/image.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>

namespace aglow::obj {
namespace {

/// MTL numbers as they may be used: finite and not negative.
float sane(float v) { return std::isfinite(v) && v > 0 ? v : 0; }

vec3 color(const tinyobj::real_t (&c)[3]) { return {sane(c[0]), sane(c[1]), sane(c[2])}; }

/// The file alone: a texture may have been shared by hand without its folders.
Result<TextureImage> load_image(const std::string& file, const std::filesystem::path& folder) {
    AG_TRY(const std::filesystem::path path, path_in_folder(file, folder));
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    AG_TRY(TextureImage image, gltf::decode_image(bytes, fmt::format("texture \"{}\"", file)));
    image.name = path.stem().string();
    return image;
}

}  // namespace

Result<std::filesystem::path> path_in_folder(std::string name,
                                             const std::filesystem::path& folder) {
    std::replace(name.begin(), name.end(), '\\', '/');
    name = std::string(trimmed(name));
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    const std::filesystem::path path(name);
    const bool leaves = std::find(path.begin(), path.end(), "..") != path.end();
    const bool has_drive = name.size() > 1 && name[1] == ':';
    if (name.empty() || path.is_absolute() || leaves || has_drive ||
        std::any_of(name.begin(), name.end(), is_control))
        return fail(Errc::unreadable, fmt::format("\"{}\" is no file in the folder", name));
    return folder / path;
}

void MaterialLibrary::add(const tinyobj::material_t& source) {
    Material material;
    material.name = std::string(trimmed(source.name));
    const vec3 diffuse = color(source.diffuse);
    const float opacity =
        std::isfinite(source.dissolve) ? std::clamp(source.dissolve, 0.0f, 1.0f) : 1;
    material.base_color = {std::min(diffuse.x, 1.0f), std::min(diffuse.y, 1.0f),
                           std::min(diffuse.z, 1.0f), opacity};
    material.metallic = 0;
    material.emission = color(source.emission);
    if (opacity < 1) material.alpha_mode = AlphaMode::blend;
    material.base_color_texture = texture(source.diffuse_texname, material.name);
    material.emissive_texture = texture(source.emissive_texname, material.name);
    if (!source.alpha_texname.empty())
        scene_.warnings.push_back(fmt::format("material \"{}\": map_d is not used", material.name));

    int& index = index_of_.try_emplace(material.name, -1).first->second;
    if (index < 0) {
        index = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
    } else {
        scene_.materials[static_cast<size_t>(index)] = std::move(material);
    }
}

int MaterialLibrary::find(const std::string& name) {
    const auto [at, is_new] = index_of_.try_emplace(std::string(trimmed(name)), -1);
    if (is_new) scene_.warnings.push_back(fmt::format("material \"{}\" does not exist", at->first));
    return at->second;
}

TextureRef MaterialLibrary::texture(const std::string& file, const std::string& material) {
    if (file.empty()) return {};
    const auto [at, is_new] = texture_of_.try_emplace(file, -1);
    if (is_new) {
        Result<TextureImage> image = load_image(file, folder_);
        if (image) {
            at->second = static_cast<int>(scene_.textures.size());
            Texture texture;
            texture.image = static_cast<int>(scene_.images.size());
            scene_.images.push_back(std::move(*image));
            scene_.textures.push_back(texture);
        } else {
            scene_.warnings.push_back(fmt::format("material \"{}\": {}, its texture is left out",
                                                  material, to_string(image.error())));
        }
    }
    TextureRef reference;
    reference.texture = at->second;
    return reference;
}

}  // namespace aglow::obj
