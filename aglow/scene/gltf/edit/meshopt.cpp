// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/decompress.h"

namespace aglow::gltf::edit {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

}  // namespace

void drop_meshopt(Document& document) {
    if (list_of(document.json, "bufferViews").empty()) return;
    for (Json& view : document.json.at("bufferViews")) erase_extension(view, kExtension);
    for (Json& buffer : document.json.at("buffers")) erase_extension(buffer, kExtension);
    drop_extension_if_unused(document, kExtension);
}

}  // namespace aglow::gltf::edit
