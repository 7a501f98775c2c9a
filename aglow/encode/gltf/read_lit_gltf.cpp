// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/lit_meshes.h"
#include "aglow/encode/lit_gltf.h"
#include "aglow/scene/gltf/edit/document.h"
#include "aglow/scene/gltf/edit/elements.h"
#include "aglow/scene/gltf/edit/pack.h"
#include "aglow/scene/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>

namespace aglow {
namespace {

namespace fs = std::filesystem;
using encode::Json;

/// What an extension says about the light, and which element said so.
struct Described {
    int texture = -1;
    int texcoord = 1;
    float intensity = 1;
    std::string exr;
    float texel_size = 0;
    std::string element;
};

float finite(const Json& object, const char* key, float otherwise) {
    const auto found = object.find(key);
    const float value = found == object.end() ? otherwise : found->get<float>();
    return std::isfinite(value) ? value : otherwise;
}

/// `texture_info` holds index and texCoord; `extension` the rest.
Described describe(const Json& texture_info, const Json& extension, std::string element) {
    Described light;
    light.texture = encode::integer(texture_info, "index");
    light.texcoord = encode::integer(texture_info, "texCoord", 1);
    light.intensity = finite(extension, "intensity", 1);
    const auto extras = extension.find("extras");
    if (extras != extension.end() && extras->is_object()) {
        light.exr = extras->value("exr", "");
        light.texel_size = finite(*extras, "texel_size_m", 0);
    }
    light.element = std::move(element);
    return light;
}

/// Collects what all elements say; they must speak of one texture and one UV set.
struct Found {
    std::optional<Described> light;

    Status add(Described next) {
        if (!light)
            light = std::move(next);
        else if (light->texture != next.texture || light->texcoord != next.texcoord)
            return fail(Errc::unsupported,
                        fmt::format("{} and {} have different lightmaps; one per file can be read",
                                    light->element, next.element));
        return {};
    }
};

Result<Described> find_light(const Json& json) {
    Found found;
    const Json& materials = encode::list_of(json, "materials");
    for (size_t i = 0; i < materials.size(); ++i) {
        if (const Json* moz = encode::find_extension(materials[i], encode::kMoz))
            AG_CHECK(found.add(describe(*moz, *moz, fmt::format("material {}", i))));
    }
    const Json& nodes = encode::list_of(json, "nodes");
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (const Json* mx = encode::find_extension(nodes[i], encode::kMx))
            AG_CHECK(
                found.add(describe(mx->at("lightMapTexture"), *mx, fmt::format("node {}", i))));
    }
    if (!found.light)
        return fail(Errc::bad_argument, "the scene carries no light; `aglow bake` gives it some");
    return *std::move(found.light);
}

/// Encoded bytes of an image of the scene; empty where it does not exist.
std::span<const uint8_t> image_bytes(const encode::Document& document, int index) {
    const Json& images = encode::list_of(document.json, "images");
    if (index < 0 || static_cast<size_t>(index) >= images.size()) return {};
    const int view = encode::integer(images[static_cast<size_t>(index)], "bufferView");
    if (view < 0) return document.source->images.at(static_cast<size_t>(index));
    const Json& json = document.json.at("bufferViews").at(static_cast<size_t>(view));
    const auto buffer = document.buffer(json.at("buffer").get<size_t>());
    return buffer.subspan(json.value("byteOffset", size_t{0}), json.at("byteLength").get<size_t>());
}

/// Light as any viewer sees it. Loading decodes only the images that materials show, so that this
/// one has to be decoded here.
Result<Image> png_light(const encode::Document& document, const Described& light) {
    const Json& textures = encode::list_of(document.json, "textures");
    std::span<const uint8_t> bytes;
    if (light.texture >= 0 && static_cast<size_t>(light.texture) < textures.size()) {
        const Json& texture = textures[static_cast<size_t>(light.texture)];
        bytes = image_bytes(document, encode::integer(texture, "source"));
    }
    if (bytes.empty())
        return fail(Errc::malformed, fmt::format("{}: lightmap texture {} does not exist",
                                                 light.element, light.texture));
    auto image = decode_image(bytes);
    if (!image)
        return fail(image.error().code, fmt::format("{}: the lightmap does not decode: {}",
                                                    light.element, image.error().message));
    for (vec3& pixel : image->pixels) pixel *= light.intensity;
    return image;
}

bool is_light(const Image& image) {
    return std::ranges::all_of(image.pixels, [](vec3 c) {
        return c.x >= 0 && c.y >= 0 && c.z >= 0 && std::isfinite(c.x + c.y + c.z);
    });
}

/// The EXR, or else the PNG and a warning that says why.
Result<Image> read_light(const encode::Document& document, const Described& light,
                         const fs::path& path, std::vector<std::string>& warnings) {
    if (light.exr.empty()) return png_light(document, light);
    const fs::path name = fs::path(light.exr).lexically_normal();
    if (name.has_root_path() || name.empty() || *name.begin() == "..")
        return fail(Errc::malformed, fmt::format("{}: lightmap file \"{}\" leaves the folder",
                                                 light.element, light.exr));
    auto image = read_image(path.parent_path() / name);
    if (image && !image->pixels.empty() && is_light(*image)) return image;
    warnings.push_back(fmt::format(
        "lightmap {} is missing or damaged; the 8-bit PNG in the scene is used", light.exr));
    return png_light(document, light);
}

vec2 pair_at(const Json& object, const char* key, vec2 otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    return {found->at(0).get<float>(), found->at(1).get<float>()};
}

/// Scale and offset of every instance of a node, in the unit square of the atlas.
struct Maps {
    std::vector<vec2> scales, offsets;
};

Result<std::vector<vec2>> instance_pairs(const encode::Document& document, const Json& instancing,
                                         const char* name, size_t count) {
    const auto& attributes = instancing.at("attributes");
    const auto found = attributes.find(name);
    if (found == attributes.end()) return std::vector<vec2>();
    AG_TRY(const auto elements, encode::read_elements(document, found->get<int>()));
    if (elements.component_type != encode::kFloat || elements.type != "VEC2" ||
        elements.count < count)
        return fail(Errc::malformed, fmt::format("{} does not fit the instances", name));
    std::vector<vec2> pairs(count);
    std::memcpy(pairs.data(), elements.bytes.data(), count * sizeof(vec2));
    return pairs;
}

Result<Maps> maps_of(const encode::Document& document, size_t node, size_t count) {
    Maps maps;
    const Json& nodes = encode::list_of(document.json, "nodes");
    if (node >= nodes.size()) return maps;
    if (const Json* mx = encode::find_extension(nodes[node], encode::kMx)) {
        maps.scales.assign(count, pair_at(*mx, "scale", {1, 1}));
        maps.offsets.assign(count, pair_at(*mx, "offset", {0, 0}));
    }
    if (const Json* instancing = encode::find_extension(nodes[node], encode::kInstancing)) {
        AG_TRY(auto scales, instance_pairs(document, *instancing, "_LIGHTMAP_SCALE", count));
        AG_TRY(auto offsets, instance_pairs(document, *instancing, "_LIGHTMAP_OFFSET", count));
        if (!scales.empty()) maps.scales = std::move(scales);
        if (!offsets.empty()) maps.offsets = std::move(offsets);
    }
    return maps;
}

Status add_placements(const encode::Document& document, const Scene& scene, size_t n,
                      Atlas& atlas) {
    const Node& node = scene.nodes[n];
    if (!node.in_scene || node.mesh < 0) return {};
    const size_t count = std::max<size_t>(1, node.instances.size());
    const auto maps = maps_of(document, n, count);
    if (!maps)
        return fail(maps.error().code,
                    fmt::format("node {} \"{}\": {}", n, node.name, maps.error().message));
    const vec2 size{static_cast<float>(atlas.width), static_cast<float>(atlas.height)};
    for (size_t i = 0; i < count; ++i) {
        const vec2 scale = i < maps->scales.size() ? maps->scales[i] : vec2{1, 1};
        const vec2 offset = i < maps->offsets.size() ? maps->offsets[i] : vec2{0, 0};
        if (!std::isfinite(scale.x + scale.y + offset.x + offset.y))
            return fail(Errc::malformed, fmt::format("node {} \"{}\": lightmap scale or offset "
                                                     "is not finite",
                                                     n, node.name));
        atlas.placements.push_back(
            {static_cast<int>(n), static_cast<int>(i), node.mesh, scale * size, offset * size});
    }
    return {};
}

/// The UV set of the light becomes every primitive's lightmap UVs; those without it see the
/// corner of the atlas.
void take_uvs(Scene& scene, int set) {
    for (Mesh& mesh : scene.meshes) {
        for (Primitive& primitive : mesh.primitives) {
            const auto index = static_cast<size_t>(set);
            primitive.lightmap_uvs = index < primitive.texcoords.size() ? primitive.texcoords[index]
                                                                        : std::vector<vec2>();
            primitive.lightmap_uvs.resize(primitive.positions.size(), vec2{0, 0});
        }
    }
}

Result<Lit> read(Scene& scene, const fs::path& path) {
    if (!scene.source)
        return fail(Errc::bad_argument, "only glTF files carry light; `aglow bake` writes one");
    AG_TRY(const auto document, encode::open_document(scene));
    AG_TRY(const Described light, find_light(document.json));
    if (light.texcoord < 0)
        return fail(Errc::malformed, fmt::format("{}: texCoord is negative", light.element));
    Lit lit;
    AG_TRY(lit.irradiance, read_light(document, light, path, scene.warnings));
    lit.atlas.width = lit.irradiance.width;
    lit.atlas.height = lit.irradiance.height;
    lit.atlas.texel_size = light.texel_size;
    lit.atlas.origins.assign(scene.meshes.size(), UvOrigin::file);
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        AG_CHECK(add_placements(document, scene, n, lit.atlas));
    take_uvs(scene, light.texcoord);
    return lit;
}

}  // namespace

Result<Lit> read_lit_gltf(Scene& scene, const fs::path& path) try {
    return read(scene, path).map_error([&](Error error) {
        if (error.context.empty()) error.context = path.string();
        return error;
    });
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "no memory for the lightmap", path.string());
} catch (const nlohmann::json::exception& error) {
    return fail(Errc::malformed, fmt::format("a lightmap extension is wrong: {}", error.what()),
                path.string());
} catch (const std::exception& error) {
    return fail(Errc::malformed, fmt::format("the light cannot be read: {}", error.what()),
                path.string());
}

}  // namespace aglow
