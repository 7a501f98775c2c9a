// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace aglow::glb {

/// Keeps the order of keys: files list what they hold in the order in which it was added.
using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
inline constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
inline constexpr int kVertices = 34962, kIndices = 34963;  // buffer view targets
inline constexpr int kOther = 0;                           // a view without a target

/// A GLB while it is made: its JSON, and the binary chunk that this describes.
class Builder {
public:
    Json json = {{"asset", {{"version", "2.0"}, {"generator", "Aglow"}}}};

    /// The extension's object in `owner`; extensionsUsed will list it.
    Json& use(Json& owner, const char* extension);

    /// Gives the accessor's index. `width` items make one element.
    template <class T>
    size_t add_accessor(const std::vector<T>& items, const char* type, int component, int target,
                        size_t width = 1) {
        const size_t view = add_view(items.data(), items.size() * sizeof(T));
        if (target != kOther) json["bufferViews"][view]["target"] = target;
        json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", component},
                                     {"count", items.size() / width},
                                     {"type", type}});
        return json["accessors"].size() - 1;
    }
    size_t add_view(const void* data, size_t size);

    /// Errors  bad_argument  more than 4 GiB
    Result<std::vector<uint8_t>> finish();

private:
    std::vector<uint8_t> bin_;
    std::set<std::string> extensions_;
};

Json to_json(vec2 v);
Json to_json(vec3 v);
Json to_json(vec4 v);
/// Things without a name have no such member.
void put_name(Json& object, const std::string& name);

// What a scene consists of, each with all that it alone refers to.
void add_nodes(Builder& glb, const Scene& scene);
Status add_meshes(Builder& glb, const Scene& scene);
Status add_skins(Builder& glb, const Scene& scene);
void add_animations(Builder& glb, const Scene& scene);
void add_materials(Builder& glb, const Scene& scene);
Status add_textures(Builder& glb, const Scene& scene);
void add_cameras(Builder& glb, const Scene& scene);
void add_lights(Builder& glb, const Scene& scene);

}  // namespace aglow::glb
