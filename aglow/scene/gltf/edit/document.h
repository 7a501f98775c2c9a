// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf_source.h"
#include "aglow/scene/scene.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::gltf::edit {

/// Keeps the order of keys, so that an edited document reads like the one it came from.
using Json = nlohmann::ordered_json;

inline constexpr int kFloat = 5126;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kVertexTarget = 34962;
inline constexpr int kIndexTarget = 34963;

/// A glTF document that is edited in place. Buffers of the source stay as they are; what is added
/// goes into one more buffer, `added`, whose index is the number of source buffers.
///
/// Functions that read or edit `json` throw nlohmann::json::exception where its structure is not
/// glTF's; the public functions that use them turn that into an error.
struct Document {
    Json json;
    std::shared_ptr<const GltfSource> source;
    std::vector<uint8_t> added;
    /// Slots of accessors and bufferViews that nothing refers to any more: the next ones added take
    /// them, so that replaced data leaves the file without renumbering anything.
    std::vector<int> free_accessors;
    std::vector<int> free_views;
    std::vector<int> accessor_uses;  ///< [accessor] references from the rest of the document
    std::vector<int> view_uses;      ///< [bufferView]
    int own_image = -1;              ///< image whose content is not the source's any more
    bool may_reuse = false;          ///< no unknown extension could refer to a slot unseen

    std::span<const uint8_t> buffer(size_t index) const;
};

/// Parses the scene's source; a scene without one is first written as glTF.
/// Errors  malformed (nested too deep, or no JSON), those of to_glb().
Result<Document> open_document(const Scene& scene);

/// `object[key]`, or an empty array where it is missing.
const Json& list_of(const Json& object, const char* key);
/// `json[key]`, made an empty array where it is missing.
Json& array_of(Json& json, const char* key);
/// Integer member, or `otherwise` where it is missing.
int integer(const Json& object, const char* key, int otherwise = -1);

/// Appends bytes as a bufferView. `target` and `stride` are written where they are not 0.
int add_view(Document& document, std::span<const uint8_t> bytes, int target = 0, int stride = 0);
int add_accessor(Document& document, Json accessor);
/// Appends to json[key] and gives the index.
int add_element(Document& document, const char* key, Json element);

/// The bufferViews that an accessor reads, sparse ones included; -1 for none.
std::vector<int> views_of(const Json& accessor);

/// Takes one reference away; what nothing refers to any more leaves its slot (and views) free.
void release_accessor(Document& document, int accessor);
void release_view(Document& document, int view);

/// Empties the slots that are free: what they hold belongs to others. Those at the end of their
/// lists go.
void sweep_free_slots(Document& document);

/// Keeps extensionsUsed (and extensionsRequired) true.
void use_extension(Document& document, std::string_view name);
void drop_extension_if_unused(Document& document, std::string_view name);

/// Member of the element's extensions object, or null.
const Json* find_extension(const Json& element, std::string_view name);
void erase_extension(Json& element, std::string_view name);

}  // namespace aglow::gltf::edit
