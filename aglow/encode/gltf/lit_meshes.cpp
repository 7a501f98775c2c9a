// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/lit_meshes.h"

#include "aglow/encode/gltf/split.h"
#include "aglow/scene/gltf/edit/decompress.h"
#include "aglow/scene/gltf/edit/elements.h"

#include <fmt/format.h>

namespace aglow::encode {
namespace {

std::string set_name(int set) { return fmt::format("TEXCOORD_{}", set); }

/// UV sets that textures of the material read, at any depth; a missing texCoord means 0.
void add_used_sets(const Json& json, std::set<int>& sets) {
    if (json.is_object()) {
        const auto set = json.find("texCoord");
        if (set != json.end()) sets.insert(set->get<int>());
        if (set == json.end() && json.contains("index")) sets.insert(0);
    }
    if (!json.is_structured()) return;
    for (const Json& value : json) add_used_sets(value, sets);
}

int free_uv_set(const Json& json) {
    std::set<int> used;
    add_used_sets(list_of(json, "materials"), used);
    int set = 1;
    while (used.contains(set)) ++set;
    return set;
}

bool reads_set(const LitScene& lit, const Json& primitive, int set) {
    std::set<int> used;
    for (const int material : materials_of(primitive)) {
        if (material < 0) continue;
        add_used_sets(lit.document.json.at("materials").at(static_cast<size_t>(material)), used);
    }
    return used.contains(set);
}

/// The texture of an earlier bake, so that baking again does not pile up lightmaps.
int take_old_light(Json& json) {
    int texture = -1;
    for (Json& material : array_of(json, "materials")) {
        const Json* moz = find_extension(material, kMoz);
        if (moz && moz->contains("extras") && moz->at("extras").contains("exr"))
            texture = integer(*moz, "index");
        erase_extension(material, kMoz);
    }
    for (Json& node : array_of(json, "nodes")) erase_extension(node, kMx);
    for (const char* key : {"materials", "nodes"}) {
        if (json.at(key).empty()) json.erase(key);
    }
    return texture;
}

void find_placements(LitScene& lit) {
    lit.placements_of_mesh.resize(lit.scene.meshes.size());
    lit.placements_of_node.resize(lit.scene.nodes.size());
    for (size_t i = 0; i < lit.atlas.placements.size(); ++i) {
        const Placement& placement = lit.atlas.placements[i];
        lit.placements_of_mesh.at(static_cast<size_t>(placement.mesh)).push_back(i);
        lit.placements_of_node.at(static_cast<size_t>(placement.node)).push_back(i);
    }
}

/// Removes the set that the light takes, and lower sets that an earlier bake filled with it.
void drop_old_uvs(LitScene& lit, Json& primitive) {
    Json& attributes = primitive.at("attributes");
    const int old = integer(attributes, set_name(lit.uv_set).c_str());
    if (old < 0) return;
    const bool baked_before = lit.texture >= 0;
    for (int set = 0; set <= lit.uv_set; ++set) {
        if (integer(attributes, set_name(set).c_str()) != old) continue;
        const bool filler = baked_before && !reads_set(lit, primitive, set);
        if (set != lit.uv_set && !filler) continue;
        attributes.erase(set_name(set));
        release_accessor(lit.document, old);
    }
}

Status split_primitive(LitScene& lit, size_t mesh, size_t index) {
    const Primitive& primitive = lit.scene.meshes[mesh].primitives[index];
    if (primitive.triangles.empty()) return {};
    if (primitive.lightmap_uvs.size() != primitive.positions.size()) return {};
    // A scene without source was written from its split vertices: they are the file's.
    Primitive unsplit;
    if (!lit.scene.source) {
        unsplit.positions = primitive.positions;
        unsplit.triangles = primitive.triangles;
    }
    Json json = lit.json().at("meshes").at(mesh).at("primitives").at(index);
    drop_old_uvs(lit, json);
    const Primitive& wanted = lit.scene.source ? primitive : unsplit;
    auto vertices = split_vertices(lit.document, json, wanted);
    if (!vertices)
        return fail(vertices.error().code,
                    fmt::format("mesh {} \"{}\": primitive {}: {}", mesh,
                                lit.scene.meshes[mesh].name, index, vertices.error().message));
    lit.json()["meshes"][mesh]["primitives"][index] = std::move(json);
    lit.vertices[{mesh, index}] = std::move(*vertices);
    return {};
}

}  // namespace

Result<LitScene> open_lit_scene(const Scene& scene, const Atlas& atlas) {
    AG_TRY(auto document, open_document(scene));
    LitScene lit{scene, atlas, std::move(document)};
    lit.texture = take_old_light(lit.json());
    lit.uv_set = free_uv_set(lit.json());
    find_placements(lit);
    drop_meshopt(lit.document);
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        if (lit.placements_of_mesh[m].empty()) continue;
        for (size_t p = 0; p < scene.meshes[m].primitives.size(); ++p)
            AG_CHECK(split_primitive(lit, m, p));
    }
    drop_extension_if_unused(lit.document, "KHR_draco_mesh_compression");
    for (const char* name : {kMoz, kMx}) drop_extension_if_unused(lit.document, name);
    return lit;
}

UvMap uv_map(const Atlas& atlas, const Placement& placement) {
    const vec2 size{static_cast<float>(atlas.width), static_cast<float>(atlas.height)};
    return {{placement.scale.x / size.x, placement.scale.y / size.y},
            {placement.offset.x / size.x, placement.offset.y / size.y}};
}

void set_uvs(LitScene& lit, size_t mesh, size_t primitive, Json& json, const UvMap& map) {
    const auto& uvs = lit.scene.meshes[mesh].primitives[primitive].lightmap_uvs;
    std::vector<float> values;
    for (const uint32_t vertex : lit.vertices.at({mesh, primitive})) {
        const vec2 uv = map.offset + map.scale * uvs[vertex];
        values.insert(values.end(), {uv.x, uv.y});
    }
    const int accessor = add_floats(lit.document, values, "VEC2", kVertexTarget);
    Json& attributes = json.at("attributes");
    for (int set = 0; set < lit.uv_set; ++set) {
        if (attributes.contains(set_name(set))) continue;
        // A texture that reads a set the primitive lacks reads zeros; any other may see the
        // light's.
        const bool zeros = reads_set(lit, json, set);
        attributes[set_name(set)] =
            zeros
                ? add_floats(lit.document, std::vector<float>(values.size()), "VEC2", kVertexTarget)
                : accessor;
    }
    attributes[set_name(lit.uv_set)] = accessor;
}

std::set<int> materials_of(const Json& primitive) {
    std::set<int> materials = {integer(primitive, "material")};
    if (const Json* variants = find_extension(primitive, kVariants)) {
        for (const Json& mapping : list_of(*variants, "mappings"))
            materials.insert(integer(mapping, "material"));
    }
    return materials;
}

void replace_materials(Json& primitive, const std::map<int, int>& replacements) {
    const auto replace = [&](Json& object) {
        const auto found = replacements.find(integer(object, "material"));
        if (found != replacements.end()) object["material"] = found->second;
    };
    replace(primitive);
    if (!find_extension(primitive, kVariants)) return;
    for (Json& mapping : array_of(primitive["extensions"][kVariants], "mappings")) replace(mapping);
}

void add_light_texture(LitScene& lit, std::span<const uint8_t> png, const std::string& uri) {
    Document& document = lit.document;
    Json image = {{"name", "lightmap"}};
    if (uri.empty()) {
        image["mimeType"] = "image/png";
        image["bufferView"] = add_view(document, png);
    } else {
        image["uri"] = uri;
    }
    if (lit.texture >= 0) {
        const Json& texture = lit.json().at("textures").at(static_cast<size_t>(lit.texture));
        document.own_image = integer(texture, "source");
        Json& old = lit.json().at("images").at(static_cast<size_t>(document.own_image));
        const int old_view = integer(old, "bufferView");
        old = std::move(image);
        release_view(document, old_view);
        return;
    }
    constexpr int kLinear = 9729;
    constexpr int kClamp = 33071;
    // No mipmaps: gutters are only wide enough for the full resolution.
    const int sampler = add_element(
        document, "samplers",
        {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClamp}, {"wrapT", kClamp}});
    const int source = add_element(document, "images", std::move(image));
    lit.texture = add_element(document, "textures",
                              {{"name", "lightmap"}, {"sampler", sampler}, {"source", source}});
}

}  // namespace aglow::encode
