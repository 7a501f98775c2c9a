// SPDX-License-Identifier: Apache-2.0
// Compares the attributes of two glTF files corner by corner.
#pragma once
#include "aglow/encode/testing/round_trip.h"
#include "aglow/scene/gltf/edit/decompress.h"

#include <algorithm>

namespace aglow::encode::testing {

using namespace gltf::edit;

inline uint32_t source_of(const Primitive& primitive, uint32_t vertex) {
    return primitive.source_vertex.empty() ? vertex : primitive.source_vertex[vertex];
}

/// Bytes of the element that a corner of a triangle has in an attribute.
inline std::span<const uint8_t> at_corner(const Elements& elements, const Primitive& primitive,
                                          size_t triangle, int corner) {
    const uvec3 t = primitive.triangles[triangle];
    const uint32_t vertex = source_of(primitive, corner == 0 ? t.x : corner == 1 ? t.y : t.z);
    return std::span(elements.bytes).subspan(vertex * elements.size, elements.size);
}

/// Raw bytes of one attribute must be the same at every triangle corner.
inline void check_attribute(const Document& before, const Primitive& old_primitive, int old_index,
                            const Document& after, const Primitive& new_primitive, int new_index) {
    const Json& old_json = before.json["accessors"][static_cast<size_t>(old_index)];
    const Json& new_json = after.json["accessors"][static_cast<size_t>(new_index)];
    for (const char* key : {"componentType", "type", "normalized", "name", "extras"})
        CHECK(old_json.value(key, Json()) == new_json.value(key, Json()));
    const auto x = read_elements(before, old_index), y = read_elements(after, new_index);
    REQUIRE((x && y));
    size_t different = 0;
    for (size_t t = 0; t < old_primitive.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            if (!std::ranges::equal(at_corner(*x, old_primitive, t, i),
                                    at_corner(*y, new_primitive, t, i)))
                ++different;
        }
    }
    CHECK(different == 0);
}

/// All attributes and morph targets but the light's UV set.
inline void check_primitive(const Document& before, const Json& old_json, const Primitive& old_p,
                            const Document& after, const Json& new_json, const Primitive& new_p) {
    REQUIRE(old_p.triangles.size() == new_p.triangles.size());
    const auto compare = [&](const Json& old_attributes, const Json& new_attributes) {
        for (const auto& [name, accessor] : old_attributes.items()) {
            if (name == "TEXCOORD_1") continue;
            CAPTURE(name);
            REQUIRE(new_attributes.contains(name));
            check_attribute(before, old_p, accessor.get<int>(), after, new_p,
                            new_attributes[name].get<int>());
        }
    };
    compare(old_json["attributes"], new_json["attributes"]);
    const Json& targets = list_of(old_json, "targets");
    for (size_t t = 0; t < targets.size(); ++t) compare(targets[t], new_json["targets"][t]);
}

/// Every primitive of the file; those compressed by Draco are left out, since their accessors say
/// nothing by themselves.
inline void check_attributes(const Scene& before, const Scene& after) {
    auto a = open_document(before), b = open_document(after);
    REQUIRE((a && b));
    drop_meshopt(*a);
    for (size_t m = 0; m < before.meshes.size(); ++m) {
        for (size_t p = 0; p < before.meshes[m].primitives.size(); ++p) {
            const Json& old_json = a->json["meshes"][m]["primitives"][p];
            const Json& new_json = b->json["meshes"][m]["primitives"][p];
            if (find_extension(old_json, "KHR_draco_mesh_compression")) continue;
            check_primitive(*a, old_json, before.meshes[m].primitives[p], *b, new_json,
                            after.meshes[m].primitives[p]);
        }
    }
}

}  // namespace aglow::encode::testing
