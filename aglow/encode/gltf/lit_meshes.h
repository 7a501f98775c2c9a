// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/unwrap.h"
#include "aglow/scene/gltf/edit/document.h"

#include <map>
#include <set>
#include <utility>

namespace aglow::encode {

using namespace gltf::edit;

inline constexpr const char* kMoz = "MOZ_lightmap";
inline constexpr const char* kMx = "MX_lightmap";
inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
inline constexpr const char* kVariants = "KHR_materials_variants";

/// A scene in the middle of being lit: the document, and how it hangs together with the light.
struct LitScene {
    const Scene& scene;
    const Atlas& atlas;
    Document document;
    int uv_set = 1;    ///< TEXCOORD_n that holds the lightmap UVs in the whole file
    int texture = -1;  ///< index of the texture that holds the light
    std::vector<std::vector<size_t>> placements_of_mesh = {};  ///< [mesh] into atlas.placements
    std::vector<std::vector<size_t>> placements_of_node = {};  ///< [node]
    /// (mesh, primitive) of all lit primitives, and for each vertex of the glTF primitive the
    /// vertex of the Scene's.
    std::map<std::pair<size_t, size_t>, std::vector<uint32_t>> vertices = {};

    bool is_lit(size_t mesh, size_t primitive) const {
        return vertices.contains({mesh, primitive});
    }
    bool is_shared(size_t mesh) const { return placements_of_mesh[mesh].size() > 1; }
    Json& json() { return document.json; }
};

/// Opens the scene's document, takes old light out of it, chooses the UV set and writes all lit
/// primitives as unwrap() split them, still without lightmap UVs.
/// Errors  malformed, those of open_document().
Result<LitScene> open_lit_scene(const Scene& scene, const Atlas& atlas);

/// Scale and offset from the mesh's unit square to the atlas's, (0, 0) at the top left.
struct UvMap {
    vec2 scale = {1, 1};
    vec2 offset = {0, 0};
};
UvMap uv_map(const Atlas& atlas, const Placement& placement);

/// Adds an accessor with the lightmap UVs of a lit primitive, mapped, and makes it the primitive's
/// TEXCOORD_n; sets below n that are missing are filled, since sets must be consecutive.
void set_uvs(LitScene& lit, size_t mesh, size_t primitive, Json& json, const UvMap& map);

/// Materials a primitive may show: its own and those of its variants; -1 for the default one.
std::set<int> materials_of(const Json& primitive);
/// Points the primitive and its variants at other materials.
void replace_materials(Json& primitive, const std::map<int, int>& replacements);

/// Adds the picture of the light as texture with its sampler, in the file (embedded) or beside it
/// under `uri` where that is not empty; takes the place of one left by an earlier bake.
void add_light_texture(LitScene& lit, std::span<const uint8_t> png, const std::string& uri);

}  // namespace aglow::encode
