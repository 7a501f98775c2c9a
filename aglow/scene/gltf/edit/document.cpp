// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/document.h"

#include "aglow/scene/write.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace aglow::gltf::edit {
namespace {

// Writing JSON and copying it recurse once per level; real files stay below 20.
constexpr int kMaxDepth = 256;

bool nested_too_deep(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxDepth) return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

uint32_t word_at(std::span<const uint8_t> bytes, size_t offset) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof(word));
    return word;
}

/// Splits a GLB that this library wrote.
Result<std::shared_ptr<const GltfSource>> split_glb(std::span<const uint8_t> glb) {
    auto source = std::make_shared<GltfSource>();
    size_t at = 12;
    while (at + 8 <= glb.size()) {
        const size_t length = word_at(glb, at);
        const uint32_t kind = word_at(glb, at + 4);
        if (length > glb.size() - at - 8) return fail(Errc::malformed, "GLB chunk is cut short");
        const auto chunk = glb.subspan(at + 8, length);
        if (kind == 0x4E4F534Au) source->json.assign(chunk.begin(), chunk.end());
        if (kind == 0x004E4942u) source->buffers.emplace_back(chunk.begin(), chunk.end());
        at += 8 + length;
    }
    return std::shared_ptr<const GltfSource>(std::move(source));
}

/// Extensions whose references to accessors and bufferViews are all known here, or that have none.
bool references_known(std::string_view extension) {
    constexpr std::array<std::string_view, 4> kFamilies = {"KHR_materials_", "KHR_texture_",
                                                           "EXT_texture_", "EXT_lights_"};
    constexpr std::array<std::string_view, 11> kNames = {"KHR_lights_punctual",
                                                         "KHR_mesh_quantization",
                                                         "KHR_draco_mesh_compression",
                                                         "KHR_animation_pointer",
                                                         "KHR_xmp_json_ld",
                                                         "KHR_node_visibility",
                                                         "EXT_mesh_gpu_instancing",
                                                         "EXT_meshopt_compression",
                                                         "MSFT_lod",
                                                         "MOZ_lightmap",
                                                         "MX_lightmap"};
    return std::ranges::find(kNames, extension) != kNames.end() ||
           std::ranges::any_of(kFamilies, [&](auto f) { return extension.starts_with(f); });
}

bool all_references_known(const Json& json) {
    const auto used = json.find("extensionsUsed");
    if (used == json.end()) return true;
    return std::ranges::all_of(*used, [](const Json& name) {
        return references_known(name.get_ref<const std::string&>());
    });
}

/// True where some object below `json` has the extension.
bool extension_used(const Json& json, const std::string& name) {
    if (json.is_object()) {
        const auto extensions = json.find("extensions");
        if (extensions != json.end() && extensions->is_object() && extensions->contains(name))
            return true;
    }
    if (!json.is_structured()) return false;
    return std::ranges::any_of(json, [&](const Json& v) { return extension_used(v, name); });
}

void count(std::vector<int>& uses, int index) {
    if (index >= 0 && static_cast<size_t>(index) < uses.size()) ++uses[static_cast<size_t>(index)];
}

void count_values(std::vector<int>& uses, const Json& object) {
    for (const Json& value : object) count(uses, value.get<int>());
}

void count_primitive(Document& document, const Json& primitive) {
    count(document.accessor_uses, integer(primitive, "indices"));
    count_values(document.accessor_uses, list_of(primitive, "attributes"));
    for (const Json& target : list_of(primitive, "targets"))
        count_values(document.accessor_uses, target);
    if (const Json* draco = find_extension(primitive, "KHR_draco_mesh_compression"))
        count(document.view_uses, integer(*draco, "bufferView"));
}

void count_accessor_uses(Document& document) {
    const Json& json = document.json;
    for (const Json& mesh : list_of(json, "meshes"))
        for (const Json& primitive : list_of(mesh, "primitives"))
            count_primitive(document, primitive);
    for (const Json& skin : list_of(json, "skins"))
        count(document.accessor_uses, integer(skin, "inverseBindMatrices"));
    for (const Json& animation : list_of(json, "animations")) {
        for (const Json& sampler : list_of(animation, "samplers")) {
            count(document.accessor_uses, integer(sampler, "input"));
            count(document.accessor_uses, integer(sampler, "output"));
        }
    }
    for (const Json& node : list_of(json, "nodes")) {
        if (const Json* instancing = find_extension(node, "EXT_mesh_gpu_instancing"))
            count_values(document.accessor_uses, list_of(*instancing, "attributes"));
    }
}

void count_view_uses(Document& document) {
    for (const Json& image : list_of(document.json, "images"))
        count(document.view_uses, integer(image, "bufferView"));
    if (const Json* luminaires = find_extension(document.json, "EXT_lights_ies"))
        for (const Json& profile : list_of(*luminaires, "lights"))
            count(document.view_uses, integer(profile, "bufferView"));
    for (const Json& accessor : list_of(document.json, "accessors"))
        for (const int view : views_of(accessor)) count(document.view_uses, view);
}

/// IES files come along in a buffer: they are small, and a scene written elsewhere finds them.
void embed_light_profiles(Document& document) {
    const auto& files = document.source->light_profiles;
    for (size_t i = 0; i < files.size(); ++i) {
        if (files[i].empty()) continue;
        Json& profile = document.json["extensions"]["EXT_lights_ies"]["lights"].at(i);
        profile.erase("uri");
        profile["bufferView"] = add_view(document, files[i]);
        profile["mimeType"] = "application/x-ies-lm-63";
    }
}

void erase_name(Json& json, const char* list, std::string_view name) {
    const auto found = json.find(list);
    if (found == json.end()) return;
    for (size_t i = found->size(); i-- > 0;) {
        if ((*found)[i] == name) found->erase(i);
    }
    if (found->empty()) json.erase(list);
}

}  // namespace

std::span<const uint8_t> Document::buffer(size_t index) const {
    return index < source->buffers.size() ? std::span<const uint8_t>(source->buffers[index])
                                          : std::span<const uint8_t>(added);
}

Result<Document> open_document(const Scene& scene) {
    Document document;
    document.source = scene.source;
    if (!document.source) {
        AG_TRY(const auto glb, to_glb(scene));
        AG_TRY(document.source, split_glb(glb));
    }
    if (nested_too_deep(document.source->json))
        return fail(Errc::malformed, "JSON is nested deeper than 256 levels");
    document.json = Json::parse(document.source->json);
    document.may_reuse = all_references_known(document.json);
    document.accessor_uses.resize(list_of(document.json, "accessors").size());
    document.view_uses.resize(list_of(document.json, "bufferViews").size());
    count_accessor_uses(document);
    count_view_uses(document);
    embed_light_profiles(document);
    return document;
}

const Json& list_of(const Json& object, const char* key) {
    static const Json kNone = Json::array();
    const auto found = object.find(key);
    return found == object.end() ? kNone : *found;
}

Json& array_of(Json& json, const char* key) {
    Json& list = json[key];
    if (list.is_null()) list = Json::array();
    return list;
}

int integer(const Json& object, const char* key, int otherwise) {
    const auto found = object.find(key);
    return found == object.end() ? otherwise : found->get<int>();
}

std::vector<int> views_of(const Json& accessor) {
    std::vector<int> views = {integer(accessor, "bufferView")};
    const auto sparse = accessor.find("sparse");
    if (sparse != accessor.end()) {
        views.push_back(integer(sparse->at("indices"), "bufferView"));
        views.push_back(integer(sparse->at("values"), "bufferView"));
    }
    return views;
}

int add_element(Document& document, const char* key, Json element) {
    Json& list = array_of(document.json, key);
    list.push_back(std::move(element));
    return static_cast<int>(list.size()) - 1;
}

namespace {

/// Puts the element into a free slot, or behind the last; it has one use.
int place(Document& document, const char* key, std::vector<int>& free, std::vector<int>& uses,
          Json element) {
    if (free.empty()) {
        uses.push_back(1);
        return add_element(document, key, std::move(element));
    }
    const int slot = free.back();
    free.pop_back();
    uses[static_cast<size_t>(slot)] = 1;
    document.json[key][static_cast<size_t>(slot)] = std::move(element);
    return slot;
}

}  // namespace

int add_view(Document& document, std::span<const uint8_t> bytes, int target, int stride) {
    document.added.resize((document.added.size() + 3) / 4 * 4);
    Json view = {{"buffer", document.source->buffers.size()},
                 {"byteOffset", document.added.size()},
                 {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    if (target != 0) view["target"] = target;
    document.added.insert(document.added.end(), bytes.begin(), bytes.end());
    return place(document, "bufferViews", document.free_views, document.view_uses, std::move(view));
}

int add_accessor(Document& document, Json accessor) {
    return place(document, "accessors", document.free_accessors, document.accessor_uses,
                 std::move(accessor));
}

void release_accessor(Document& document, int accessor) {
    if (accessor < 0) return;
    const size_t slot = static_cast<size_t>(accessor);
    if (!document.may_reuse || --document.accessor_uses.at(slot) != 0) return;
    document.free_accessors.push_back(accessor);
    for (const int view : views_of(document.json.at("accessors").at(slot)))
        release_view(document, view);
}

void release_view(Document& document, int view) {
    if (view < 0 || !document.may_reuse) return;
    if (--document.view_uses.at(static_cast<size_t>(view)) == 0)
        document.free_views.push_back(view);
}

namespace {

/// Removes free slots from the end of a list, and gives the others `empty`.
void sweep(Json& json, const char* key, std::vector<int>& free, std::vector<int>& uses,
           const Json& empty) {
    if (free.empty()) return;
    Json& list = json.at(key);
    std::ranges::sort(free);
    while (!free.empty() && static_cast<size_t>(free.back()) + 1 == list.size()) {
        list.erase(list.size() - 1);
        uses.pop_back();
        free.pop_back();
    }
    for (const int slot : free) list[static_cast<size_t>(slot)] = empty;
    if (list.empty()) json.erase(key);
}

}  // namespace

void sweep_free_slots(Document& document) {
    sweep(document.json, "accessors", document.free_accessors, document.accessor_uses,
          {{"componentType", kFloat}, {"count", 1}, {"type", "SCALAR"}});
    if (document.free_views.empty()) return;
    // A view must show something: one word, which all of them share.
    const size_t word = document.added.size();
    document.added.resize((word + 3) / 4 * 4 + 4);
    sweep(document.json, "bufferViews", document.free_views, document.view_uses,
          {{"buffer", document.source->buffers.size()},
           {"byteOffset", (word + 3) / 4 * 4},
           {"byteLength", 4}});
}

void use_extension(Document& document, std::string_view name) {
    Json& used = array_of(document.json, "extensionsUsed");
    if (std::ranges::find(used, name) == used.end()) used.push_back(name);
}

void drop_extension_if_unused(Document& document, std::string_view name) {
    const bool used = extension_used(document.json, std::string(name));
    if (used) return;
    erase_name(document.json, "extensionsUsed", name);
    erase_name(document.json, "extensionsRequired", name);
}

const Json* find_extension(const Json& element, std::string_view name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end()) return nullptr;
    const auto found = extensions->find(std::string(name));
    return found == extensions->end() ? nullptr : &*found;
}

void erase_extension(Json& element, std::string_view name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end()) return;
    extensions->erase(std::string(name));
    if (extensions->empty()) element.erase("extensions");
}

}  // namespace aglow::gltf::edit
