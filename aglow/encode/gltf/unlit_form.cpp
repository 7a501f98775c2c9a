// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/forms.h"

namespace aglow::encode {
namespace {

constexpr const char* kUnlit = "KHR_materials_unlit";

/// The material with all its light in one texture. What unlit viewers ignore stays in place;
/// what they would apply a second time goes.
Json unlit_material(const LitScene& lit, int material) {
    Json json = material < 0 ? Json{{"name", "default"}}
                             : lit.document.json.at("materials").at(static_cast<size_t>(material));
    Json& pbr = json["pbrMetallicRoughness"];
    pbr["baseColorFactor"] = {1, 1, 1, 1};
    pbr["baseColorTexture"] = {{"index", lit.texture}, {"texCoord", lit.uv_set}};
    // The texture's alpha is the share of a texel that the mask keeps.
    if (json.value("alphaMode", "OPAQUE") == "MASK") json["alphaCutoff"] = 0.5;
    erase_extension(json, "KHR_materials_pbrSpecularGlossiness");
    json["extensions"][kUnlit] = Json::object();
    return json;
}

/// The primitive without what would colour it again: vertex colours (kept under a name of their
/// own) and material variants, which were not what light was computed with.
void strip(Json& primitive) {
    Json& attributes = primitive.at("attributes");
    Json renamed = Json::object();
    for (const auto& [name, accessor] : attributes.items())
        renamed[name.starts_with("COLOR_") ? "_" + name : name] = accessor;
    attributes = std::move(renamed);
    erase_extension(primitive, kVariants);
}

/// How often each mesh is shown: its placements, and the nodes of other scenes.
std::vector<size_t> uses_of_meshes(const LitScene& lit) {
    std::vector<size_t> uses;
    for (const auto& placements : lit.placements_of_mesh) uses.push_back(placements.size());
    const Json& nodes = list_of(lit.document.json, "nodes");
    for (size_t n = 0; n < nodes.size(); ++n) {
        const int mesh = integer(nodes[n], "mesh");
        if (mesh >= 0 && lit.placements_of_node.at(n).empty()) ++uses.at(static_cast<size_t>(mesh));
    }
    return uses;
}

class Unlit {
public:
    explicit Unlit(LitScene& lit) : lit_(lit), uses_left_(uses_of_meshes(lit)) {}

    void place_all() {
        for (size_t n = 0; n < lit_.placements_of_node.size(); ++n) {
            const auto placements = lit_.placements_of_node[n];
            if (placements.empty()) continue;
            if (find_extension(lit_.json().at("nodes").at(n), kInstancing)) {
                expand_instances(n, placements);
            } else {
                lit_.json()["nodes"][n]["mesh"] = mesh_for(placements.front());
            }
        }
        drop_extension_if_unused(lit_.document, kInstancing);
        drop_extension_if_unused(lit_.document, kVariants);
        drop_extension_if_unused(lit_.document, "KHR_materials_pbrSpecularGlossiness");
    }

private:
    int material_for(int material) {
        const auto known = materials_.find(material);
        if (known != materials_.end()) return known->second;
        use_extension(lit_.document, kUnlit);
        const int unlit = add_element(lit_.document, "materials", unlit_material(lit_, material));
        return materials_[material] = unlit;
    }

    /// Index of a mesh that shows the light of one placement: a copy, or for the last use the mesh
    /// itself.
    int mesh_for(size_t placement) {
        const Placement& place = lit_.atlas.placements[placement];
        const auto mesh = static_cast<size_t>(place.mesh);
        Json json = lit_.json().at("meshes").at(mesh);
        Json& primitives = json.at("primitives");
        for (size_t p = 0; p < primitives.size(); ++p) {
            if (!lit_.is_lit(mesh, p)) continue;
            const int material = integer(primitives[p], "material");
            set_uvs(lit_, mesh, p, primitives[p], uv_map(lit_.atlas, place));
            strip(primitives[p]);
            primitives[p]["material"] = material_for(material);
        }
        if (--uses_left_[mesh] > 0) return add_element(lit_.document, "meshes", std::move(json));
        lit_.json()["meshes"][mesh] = std::move(json);
        return place.mesh;
    }

    /// Instances share one mesh; light does not, so each becomes a node of its own.
    void expand_instances(size_t n, const std::vector<size_t>& placements) {
        Json node = lit_.json().at("nodes").at(n);
        for (const size_t placement : placements) {
            const Placement& place = lit_.atlas.placements[placement];
            Json child = {{"mesh", mesh_for(placement)}};
            const mat4& local = lit_.scene.nodes[n].instances[static_cast<size_t>(place.instance)];
            if (local != mat4{}) child["matrix"] = local.m;
            for (const char* key : {"skin", "weights"}) {
                if (node.contains(key)) child[key] = node[key];
            }
            array_of(node, "children").push_back(add_element(lit_.document, "nodes", child));
        }
        for (const char* key : {"mesh", "skin", "weights"}) node.erase(key);
        for (const Json& accessor : find_extension(node, kInstancing)->at("attributes"))
            release_accessor(lit_.document, accessor.get<int>());
        erase_extension(node, kInstancing);
        lit_.json()["nodes"][n] = std::move(node);
    }

    LitScene& lit_;
    std::vector<size_t> uses_left_;
    std::map<int, int> materials_;
};

}  // namespace

void apply_unlit_form(LitScene& lit) { Unlit(lit).place_all(); }

}  // namespace aglow::encode
