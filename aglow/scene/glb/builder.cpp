// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/glb/builder.h"

#include "aglow/scene/gltf/edit/pack.h"

namespace aglow::glb {

Json to_json(vec2 v) { return Json::array({v.x, v.y}); }
Json to_json(vec3 v) { return Json::array({v.x, v.y, v.z}); }
Json to_json(vec4 v) { return Json::array({v.x, v.y, v.z, v.w}); }

void put_name(Json& object, const std::string& name) {
    if (!name.empty()) object["name"] = name;
}

Json& Builder::use(Json& owner, const char* extension) {
    extensions_.insert(extension);
    return owner["extensions"][extension];
}

size_t Builder::add_view(const void* data, size_t size) {
    bin_.resize((bin_.size() + 3) / 4 * 4);  // accessors start at multiples of their type
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}});
    const auto* bytes = static_cast<const uint8_t*>(data);
    bin_.insert(bin_.end(), bytes, bytes + size);
    return json["bufferViews"].size() - 1;
}

Result<std::vector<uint8_t>> Builder::finish() {
    if (!extensions_.empty()) json["extensionsUsed"] = extensions_;
    if (!bin_.empty()) json["buffers"] = Json::array({{{"byteLength", bin_.size()}}});
    return gltf::edit::to_glb_bytes(json, bin_);
}

}  // namespace aglow::glb
