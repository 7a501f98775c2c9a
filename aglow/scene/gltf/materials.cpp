// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace aglow::gltf {
namespace {

/// What reading one material needs to know besides its JSON.
struct Reader {
    std::span<const Texture> textures;
    std::vector<Json> texture_list;
    std::vector<std::string>& warnings;

    void warn(const Json& json, std::string_view what) const {
        warnings.push_back(fmt::format("{}: {}", json.element(), what));
    }
};

/// Whether a format without a decoder is the reason that a texture has no image.
bool has_foreign_image(const Json& texture) {
    for (const char* name : {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"}) {
        const auto extension = texture.extension(name);
        if (extension && extension->exists()) return true;
    }
    return false;
}

Result<TextureRef> read_texture(const Reader& reader, const Json& owner, const char* key) {
    TextureRef reference;
    AG_TRY(const Json json, owner.object(key));
    if (!json.exists()) return reference;
    AG_TRY(reference.texture, json.required_index("index", reader.textures.size(), "texture"));
    AG_TRY(uint64_t texcoord, json.size("texCoord", 0));
    AG_TRY(const Json transform, json.extension("KHR_texture_transform"));
    AG_TRY(texcoord, transform.size("texCoord", texcoord));
    constexpr uint64_t kMaxTexcoord = 255;
    if (texcoord > kMaxTexcoord)
        return json.wrong(fmt::format("texCoord {} is too large", texcoord));
    reference.texcoord = static_cast<int>(texcoord);
    float offset[2] = {0, 0}, scale[2] = {1, 1};
    AG_CHECK(transform.numbers("offset", offset));
    AG_CHECK(transform.numbers("scale", scale));
    AG_TRY(reference.rotation, transform.number("rotation", 0));
    reference.offset = {offset[0], offset[1]};
    reference.scale = {scale[0], scale[1]};

    const size_t texture = static_cast<size_t>(reference.texture);
    if (reader.textures[texture].image >= 0) return reference;
    if (has_foreign_image(reader.texture_list[texture]))
        return fail(Errc::unsupported,
                    fmt::format("texture {}: its only image is in a format that is not supported",
                                texture));
    reader.warn(json, fmt::format("texture {} has no image; white is used", texture));
    return TextureRef();
}

/// Factors between 0 and 1, clamped where the file breaks that rule.
Status read_factors(const Reader& reader, const Json& json, const char* key, std::span<float> out) {
    AG_CHECK(json.numbers(key, out));
    const bool outside =
        std::any_of(out.begin(), out.end(), [](float v) { return v < 0 || v > 1; });
    if (outside) reader.warn(json, fmt::format("{} is clamped to 0..1", key));
    for (float& v : out) v = std::clamp(v, 0.0f, 1.0f);
    return {};
}

Status read_metallic_roughness(const Reader& reader, const Json& json, Material& material) {
    AG_TRY(const Json pbr, json.object("pbrMetallicRoughness"));
    float color[4] = {1, 1, 1, 1};
    AG_CHECK(read_factors(reader, pbr, "baseColorFactor", color));
    material.base_color = {color[0], color[1], color[2], color[3]};
    AG_TRY(material.base_color_texture, read_texture(reader, pbr, "baseColorTexture"));
    AG_TRY(material.metallic_roughness_texture,
           read_texture(reader, pbr, "metallicRoughnessTexture"));
    float metallic[1] = {1}, roughness[1] = {1};
    AG_TRY(metallic[0], pbr.number("metallicFactor", 1));
    AG_TRY(roughness[0], pbr.number("roughnessFactor", 1));
    for (float* factor : {metallic, roughness}) {
        if (*factor >= 0 && *factor <= 1) continue;
        reader.warn(json, "metallic or roughness factor is clamped to 0..1");
        *factor = std::clamp(*factor, 0.0f, 1.0f);
    }
    material.metallic = metallic[0];
    material.roughness = roughness[0];
    return {};
}

/// KHR_materials_pbrSpecularGlossiness replaces the whole model: its diffuse part is what light
/// needs, and takes the place of a base colour with metallic 0.
Status read_specular_glossiness(const Reader& reader, const Json& json, Material& material) {
    AG_TRY(const Json pbr, json.extension("KHR_materials_pbrSpecularGlossiness"));
    if (!pbr.exists()) return {};
    float color[4] = {1, 1, 1, 1};
    AG_CHECK(read_factors(reader, pbr, "diffuseFactor", color));
    material.base_color = {color[0], color[1], color[2], color[3]};
    AG_TRY(material.base_color_texture, read_texture(reader, pbr, "diffuseTexture"));
    AG_TRY(const float glossiness, pbr.number("glossinessFactor", 1));
    material.roughness = 1 - std::clamp(glossiness, 0.0f, 1.0f);
    material.metallic = 0;
    material.metallic_roughness_texture = {};
    return {};
}

Status read_emission(const Reader& reader, const Json& json, Material& material) {
    float factor[3] = {0, 0, 0};
    AG_CHECK(json.numbers("emissiveFactor", factor));
    AG_TRY(const Json extension, json.extension("KHR_materials_emissive_strength"));
    AG_TRY(const float strength, extension.number("emissiveStrength", 1));
    if (strength < 0) return json.wrong("emissiveStrength is negative");
    for (float& v : factor) {
        if (v < 0) return json.wrong("emissiveFactor is negative");
        v *= strength;
        if (!std::isfinite(v)) return json.wrong("emissiveFactor * emissiveStrength is not finite");
    }
    AG_TRY(const Json unlit, json.extension("KHR_materials_unlit"));
    material.unlit = unlit.exists();
    AG_TRY(material.emissive_texture, read_texture(reader, json, "emissiveTexture"));
    if (!material.unlit) material.emission = {factor[0], factor[1], factor[2]};
    return {};
}

Status read_alpha(const Json& json, Material& material) {
    AG_TRY(const std::string mode, json.text("alphaMode", "OPAQUE"));
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        return json.wrong(fmt::format("alphaMode \"{}\" does not exist", mode.substr(0, 20)));
    material.alpha_mode = mode == "MASK"    ? AlphaMode::mask
                          : mode == "BLEND" ? AlphaMode::blend
                                            : AlphaMode::opaque;
    AG_TRY(material.alpha_cutoff, json.number("alphaCutoff", 0.5f));
    if (material.alpha_cutoff < 0) return json.wrong("alphaCutoff is negative");
    AG_TRY(material.double_sided, json.boolean("doubleSided", false));
    return {};
}

/// The largest value of each channel of an image, linear.
vec3 largest_texel(const TextureImage& image) {
    uint8_t largest[3] = {0, 0, 0};
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        for (size_t k = 0; k < 3; ++k) largest[k] = std::max(largest[k], image.rgba[i + k]);
    return {srgb_to_linear(static_cast<float>(largest[0]) / 255.0f),
            srgb_to_linear(static_cast<float>(largest[1]) / 255.0f),
            srgb_to_linear(static_cast<float>(largest[2]) / 255.0f)};
}

Result<Material> read_material(const Reader& reader, const Json& json) {
    Material material;
    AG_TRY(material.name, json.text("name", ""));
    AG_CHECK(read_metallic_roughness(reader, json, material));
    AG_CHECK(read_specular_glossiness(reader, json, material));
    AG_CHECK(read_emission(reader, json, material));
    AG_CHECK(read_alpha(json, material));
    return material;
}

}  // namespace

Result<std::vector<Material>> read_materials(const Json& root, std::span<const Texture> textures,
                                             std::vector<std::string>& warnings) {
    AG_TRY(std::vector<Json> texture_list, elements(root, "textures", "texture"));
    const Reader reader{textures, std::move(texture_list), warnings};
    AG_TRY(const std::vector<Json> list, elements(root, "materials", "material"));
    std::vector<Material> materials;
    for (const Json& json : list) {
        AG_TRY(Material material, read_material(reader, json));
        materials.push_back(std::move(material));
    }
    return materials;
}

void warn_of_reflectance(Scene& scene) {
    std::vector<std::optional<vec3>> largest(scene.images.size());  // many materials share images
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        vec3 color{material.base_color.x, material.base_color.y, material.base_color.z};
        if (const int texture = material.base_color_texture.texture; texture >= 0) {
            const auto image =
                static_cast<size_t>(scene.textures[static_cast<size_t>(texture)].image);
            if (!largest[image]) largest[image] = largest_texel(scene.images[image]);
            color *= *largest[image];
        }
        // A texture may make any part of a surface less metallic than the factor says.
        const bool textured_metal = material.metallic_roughness_texture.texture >= 0;
        const float metallic = textured_metal ? 0 : material.metallic;
        const float reflectance = std::max({color.x, color.y, color.z}) * (1 - metallic);
        if (reflectance > kMaxReflectance)
            scene.warnings.push_back(fmt::format(
                "{}: reflectance {:.3g} is clamped to {} so that light dies out",
                element_name("material", i, material.name), reflectance, kMaxReflectance));
    }
}

}  // namespace aglow::gltf
