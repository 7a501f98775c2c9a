// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/forms.h"
#include "aglow/scene/gltf/edit/elements.h"

#include <algorithm>

namespace aglow::encode {
namespace {

/// Materials seen on lit primitives, and on those that carry no light.
struct MaterialUse {
    std::set<int> lit, unlit;
};

MaterialUse find_use(LitScene& lit) {
    MaterialUse use;
    const Json& meshes = list_of(lit.json(), "meshes");
    for (size_t m = 0; m < meshes.size(); ++m) {
        const Json& primitives = meshes[m].at("primitives");
        for (size_t p = 0; p < primitives.size(); ++p) {
            std::set<int> materials = materials_of(primitives[p]);
            (lit.is_lit(m, p) ? use.lit : use.unlit).merge(materials);
        }
    }
    return use;
}

Json extras_of(const LightInfo& info) {
    return {{"exr", info.exr},
            {"units", "lux"},
            {"encoding", "sRGB"},
            {"texel_size_m", info.texel_size}};
}

Json moz_extension(const LitScene& lit, const LightInfo& info) {
    return {{"index", lit.texture},
            {"texCoord", lit.uv_set},
            {"intensity", info.intensity},
            {"extras", extras_of(info)}};
}

/// A surface without material is lit as white and diffuse; glTF's default is a mirror-like metal
/// that would show none of that light.
Json default_material() {
    return {{"name", "default"},
            {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
}

/// Gives every material of a lit primitive the light. One that primitives without light use too
/// is copied for the lit ones.
void light_materials(LitScene& lit, const LightInfo& info) {
    const MaterialUse use = find_use(lit);
    std::map<int, int> replacements;
    for (const int material : use.lit) {
        Json json = material < 0 ? default_material()
                                 : lit.json().at("materials").at(static_cast<size_t>(material));
        if (find_extension(json, "KHR_materials_unlit")) continue;  // it shows no light
        json["extensions"][kMoz] = moz_extension(lit, info);
        if (material < 0 || use.unlit.contains(material)) {
            replacements[material] = add_element(lit.document, "materials", std::move(json));
        } else {
            lit.json()["materials"][static_cast<size_t>(material)] = std::move(json);
        }
        use_extension(lit.document, kMoz);
    }
    for (const auto& [key, vertices] : lit.vertices)
        replace_materials(lit.json()["meshes"][key.first]["primitives"][key.second], replacements);
}

Json pair_of(vec2 v) { return Json::array({v.x, v.y}); }

/// Where one placement finds its light. The UVs of a mesh placed once hold it already.
UvMap node_map(const LitScene& lit, size_t placement) {
    const Placement& place = lit.atlas.placements[placement];
    if (!lit.is_shared(static_cast<size_t>(place.mesh))) return {};
    return uv_map(lit.atlas, place);
}

void light_instances(LitScene& lit, Json& instancing, const std::vector<size_t>& placements) {
    std::vector<float> scales, offsets;
    for (const size_t placement : placements) {
        const UvMap map = node_map(lit, placement);
        scales.insert(scales.end(), {map.scale.x, map.scale.y});
        offsets.insert(offsets.end(), {map.offset.x, map.offset.y});
    }
    Json& attributes = instancing["attributes"];
    for (const char* name : {"_LIGHTMAP_SCALE", "_LIGHTMAP_OFFSET"}) {
        if (attributes.contains(name)) release_accessor(lit.document, attributes[name].get<int>());
    }
    attributes["_LIGHTMAP_SCALE"] = add_floats(lit.document, scales, "VEC2", 0);
    attributes["_LIGHTMAP_OFFSET"] = add_floats(lit.document, offsets, "VEC2", 0);
}

void light_node(LitScene& lit, size_t index, const LightInfo& info) {
    const auto& placements = lit.placements_of_node[index];
    Json& node = lit.json()["nodes"][index];
    Json extension = {{"lightMapTexture", {{"index", lit.texture}, {"texCoord", lit.uv_set}}},
                      {"intensity", info.intensity},
                      {"extras", extras_of(info)}};
    if (find_extension(node, kInstancing)) {
        light_instances(lit, node["extensions"][kInstancing], placements);
    } else {
        const UvMap map = node_map(lit, placements.front());
        extension["scale"] = pair_of(map.scale);
        extension["offset"] = pair_of(map.offset);
    }
    node["extensions"][kMx] = std::move(extension);
    use_extension(lit.document, kMx);
}

bool mesh_is_lit(const LitScene& lit, size_t mesh) {
    const auto next = lit.vertices.lower_bound({mesh, 0});
    return next != lit.vertices.end() && next->first.first == mesh;
}

}  // namespace

void apply_lightmap_form(LitScene& lit, const LightInfo& info) {
    for (const auto& [key, vertices] : lit.vertices) {
        const auto [mesh, primitive] = key;
        const size_t first = lit.placements_of_mesh[mesh].front();
        const UvMap map =
            lit.is_shared(mesh) ? UvMap{} : uv_map(lit.atlas, lit.atlas.placements[first]);
        set_uvs(lit, mesh, primitive, lit.json()["meshes"][mesh]["primitives"][primitive], map);
    }
    light_materials(lit, info);
    for (size_t n = 0; n < lit.placements_of_node.size(); ++n) {
        const auto& placements = lit.placements_of_node[n];
        if (placements.empty()) continue;
        const auto mesh = static_cast<size_t>(lit.atlas.placements[placements.front()].mesh);
        if (mesh_is_lit(lit, mesh)) light_node(lit, n, info);
    }
}

}  // namespace aglow::encode
