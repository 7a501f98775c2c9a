// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace aglow::gltf {
namespace {

/// Extensions whose meaning for light is implemented.
constexpr std::string_view kRead[] = {
    "KHR_lights_punctual",
    "EXT_lights_ies",
    "KHR_materials_emissive_strength",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_pbrSpecularGlossiness",
    "EXT_mesh_gpu_instancing",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "MSFT_lod",
    "MOZ_lightmap",
    "MX_lightmap",
    "AGLOW_hierarchical_color",
};

/// Extensions that leave diffuse light as it is: gloss, metadata, variants not chosen, motion of
/// properties. Textures whose images are in a foreign format are refused where they are used.
constexpr std::string_view kIrrelevant[] = {
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_variants",
    "KHR_animation_pointer",
    "KHR_xmp_json_ld",
    "KHR_xmp",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "EXT_texture_avif",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
    "ADOBE_materials_clearcoat_specular",
};

/// Extensions that change diffuse light and are not known; a file may use them as an option.
constexpr std::string_view kMissed[] = {"EXT_lights_image_based",
                                        "KHR_materials_diffuse_transmission"};

bool is_known(std::string_view name) {
    const auto holds = [&](const auto& list) {
        return std::find(std::begin(list), std::end(list), name) != std::end(list);
    };
    return holds(kRead) || holds(kIrrelevant);
}

Status check_version(const Json& root) {
    AG_TRY(const Json asset, root.object("asset"));
    if (!asset.exists()) return root.wrong("asset is missing: this is not glTF 2.0");
    AG_TRY(const std::string version, asset.text("version", ""));
    AG_TRY(const std::string minimum, asset.text("minVersion", "2.0"));
    if (!version.starts_with("2.") || minimum != "2.0")
        return fail(Errc::unsupported,
                    fmt::format("glTF version \"{}\" is not supported, 2.0 is",
                                (version.starts_with("2.") ? minimum : version).substr(0, 20)));
    return {};
}

}  // namespace

Status check_requirements(const Json& root, std::vector<std::string>& warnings) {
    AG_CHECK(check_version(root));
    AG_TRY(const Json required, root.array("extensionsRequired"));
    for (size_t i = 0; i < required.size(); ++i) {
        AG_TRY(const std::string name, required.text_at(i));
        if (!is_known(name))
            return fail(Errc::unsupported, fmt::format("required extension \"{}\" is not supported",
                                                       name.substr(0, 80)));
    }
    AG_TRY(const Json used, root.array("extensionsUsed"));
    for (size_t i = 0; i < used.size(); ++i) {
        AG_TRY(const std::string name, used.text_at(i));
        if (std::find(std::begin(kMissed), std::end(kMissed), name) != std::end(kMissed))
            warnings.push_back(name + " is not supported; its part of the light is left out");
    }
    return {};
}

}  // namespace aglow::gltf
