// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/replace_meshes.h"

#include "aglow/scene/gltf/edit/decompress.h"
#include "aglow/scene/gltf/edit/elements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace aglow::gltf::edit {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kQuantization = "KHR_mesh_quantization";
constexpr int kUnsignedByte = 5121;
constexpr int kPoints = 0;  // primitive.mode

template <class T>
std::span<const float> floats_of(const std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(float) == 0);
    return {reinterpret_cast<const float*>(values.data()),
            std::span(values).size_bytes() / sizeof(float)};
}

void set_bounds(Json& accessor, std::span<const vec3> values) {
    Box box;
    for (const vec3 v : values) box.add(v);
    accessor["min"] = {box.lo.x, box.lo.y, box.lo.z};
    accessor["max"] = {box.hi.x, box.hi.y, box.hi.z};
}

/// Writes the vertices of one primitive.
class PrimitiveWriter {
public:
    PrimitiveWriter(Document& document, const Primitive& primitive, std::span<const float> radii,
                    bool alpha)
        : document_(document), primitive_(primitive), radii_(radii), alpha_(alpha) {}

    Json attributes() {
        Json out = Json::object();
        out["POSITION"] = positions(primitive_.positions);
        out["NORMAL"] = add(primitive_.normals, "VEC3");
        for (size_t set = 0; set < primitive_.texcoords.size(); ++set)
            out[fmt::format("TEXCOORD_{}", set)] = add(primitive_.texcoords[set], "VEC2");
        if (!primitive_.colors.empty()) out["COLOR_0"] = colors();
        for (int set = 0; set < primitive_.influences / 4; ++set) {
            out[fmt::format("JOINTS_{}", set)] = joints(set);
            out[fmt::format("WEIGHTS_{}", set)] = weights(set);
        }
        if (!primitive_.sharpness.empty()) out["_SHARPNESS"] = add(primitive_.sharpness, "SCALAR");
        if (!primitive_.tension.empty()) out["_TENSION"] = add(primitive_.tension, "SCALAR");
        if (!primitive_.bias.empty()) out["_BIAS"] = add(primitive_.bias, "SCALAR");
        if (!radii_.empty())
            out["_RADIUS"] = add_floats(document_, radii_, "SCALAR", kVertexTarget);
        return out;
    }

    Json target(const MorphTarget& target) {
        Json out = Json::object();
        if (!target.positions.empty()) out["POSITION"] = positions(target.positions);
        if (!target.normals.empty()) out["NORMAL"] = add(target.normals, "VEC3");
        return out;
    }

    /// -1 for points.
    int indices() {
        if (!radii_.empty()) return -1;
        std::vector<uint32_t> values;
        values.reserve(3 * primitive_.triangles.size());
        for (const uvec3 t : primitive_.triangles) values.insert(values.end(), {t.x, t.y, t.z});
        return add_indices(document_, values, primitive_.positions.size());
    }

private:
    template <class T>
    int add(const std::vector<T>& values, const char* type) {
        return add_floats(document_, floats_of(values), type, kVertexTarget);
    }

    int positions(const std::vector<vec3>& values) {
        const int accessor = add(values, "VEC3");
        set_bounds(document_.json["accessors"][static_cast<size_t>(accessor)], values);
        return accessor;
    }

    /// Without alpha where the file had none.
    int colors() {
        if (alpha_) return add(primitive_.colors, "VEC4");
        std::vector<vec3> opaque;
        for (const vec4 c : primitive_.colors) opaque.push_back({c.x, c.y, c.z});
        return add(opaque, "VEC3");
    }

    /// Four numbers of each vertex, those of the set.
    template <class To, class From>
    std::vector<To> of_set(const std::vector<From>& values, int set) const {
        std::vector<To> out;
        const auto width = static_cast<size_t>(primitive_.influences);
        for (size_t at = 4 * static_cast<size_t>(set); at < values.size(); at += width)
            for (size_t i = at; i < at + 4; ++i) out.push_back(static_cast<To>(values[i]));
        return out;
    }

    int weights(int set) { return add(of_set<float>(primitive_.weights, set), "VEC4"); }

    int joints(int set) {
        const uint32_t highest = *std::ranges::max_element(primitive_.joints);
        const bool narrow = highest < 256;
        const auto view = [&](const auto& values) {
            return add_view(document_,
                            {reinterpret_cast<const uint8_t*>(values.data()),
                             values.size() * sizeof(values.front())},
                            kVertexTarget);
        };
        const int at = narrow ? view(of_set<uint8_t>(primitive_.joints, set))
                              : view(of_set<uint16_t>(primitive_.joints, set));
        return add_accessor(document_, {{"bufferView", at},
                                        {"componentType", narrow ? kUnsignedByte : kUnsignedShort},
                                        {"count", primitive_.positions.size()},
                                        {"type", "VEC4"}});
    }

    Document& document_;
    const Primitive& primitive_;
    std::span<const float> radii_;
    bool alpha_;
};

/// Attributes that a Scene knows nothing of; readers make tangents from the texture coordinates.
void note_lost(const Json& old, const Json& attributes, std::set<std::string>& lost) {
    for (const auto& [name, accessor] : old.items())
        if (!attributes.contains(name) && name != "TANGENT") lost.insert(name);
}

void release_all(Document& document, const Json& attributes) {
    for (const Json& accessor : attributes) release_accessor(document, accessor.get<int>());
}

/// The normals of what a displacement adds are those of the displaced mesh itself.
void drop_normal_map(Document& document, const Json& json) {
    const int material = integer(json, "material");
    if (material >= 0)
        document.json.at("materials").at(static_cast<size_t>(material)).erase("normalTexture");
}

/// What names vertices or triangles that are gone.
void drop_what_named_vertices(Document& document, Json& json) {
    if (const Json* draco = find_extension(json, kDraco)) {
        const int view = integer(*draco, "bufferView");
        erase_extension(json, kDraco);
        release_view(document, view);
    }
    if (!json.contains("extras") || !json.at("extras").is_object()) return;
    Json& extras = json.at("extras");
    extras.erase("creases");
    extras.erase("corners");
    if (extras.erase("displacement") > 0) drop_normal_map(document, json);
    if (extras.empty()) json.erase("extras");
}

/// As docs/formats/creases.md has them.
void add_sharp_tags(const Primitive& primitive, Json& json) {
    if (json.contains("extras") && !json.at("extras").is_object()) return;
    for (const SharpEdge& crease : primitive.creases)
        json["extras"]["creases"].push_back(Json::array({crease.a, crease.b, crease.sharpness}));
    for (const SharpVertex& corner : primitive.corners)
        json["extras"]["corners"].push_back(Json::array({corner.vertex, corner.sharpness}));
}

bool has_alpha(const Document& document, const Json& attributes) {
    const int color = integer(attributes, "COLOR_0");
    return color < 0 ||
           document.json.at("accessors").at(static_cast<size_t>(color)).at("type") != "VEC3";
}

/// What holds a primitive's vertices and triangles.
struct Written {
    const Primitive* primitive = nullptr;
    bool alpha = false;
    Json attributes, targets = Json::array();
    int indices = -1;
};

/// Writes primitives; those that are alike share what holds them.
class Replacer {
public:
    Replacer(Document& document, std::set<std::string>& lost) : document_(document), lost_(lost) {}

    void replace(Json& json, const Primitive& primitive, std::span<const float> radii) {
        const Json old = json.at("attributes");
        const Json old_targets = list_of(json, "targets");
        const bool alpha = has_alpha(document_, old);
        // What goes, goes first, so that its slots are taken again.
        release_all(document_, old);
        for (const Json& target : old_targets) release_all(document_, target);
        release_accessor(document_, integer(json, "indices"));
        drop_what_named_vertices(document_, json);
        if (radii.empty()) add_sharp_tags(primitive, json);
        const Written& written = write(primitive, radii, alpha, old_targets.size());
        json["attributes"] = written.attributes;
        json.erase("indices");
        json.erase("mode");  // a triangle list is the default
        if (radii.empty())
            json["indices"] = written.indices;
        else
            json["mode"] = kPoints;
        note_lost(old, written.attributes, lost_);
        for (size_t t = 0; t < old_targets.size(); ++t) {
            json["targets"][t] = written.targets[t];
            note_lost(old_targets[t], written.targets[t], lost_);
        }
    }

private:
    const Written& write(const Primitive& primitive, std::span<const float> radii, bool alpha,
                         size_t target_count) {
        auto& candidates = written_[{primitive.positions.size(), primitive.triangles.size()}];
        for (const Written& w : candidates)
            if (w.alpha == alpha && w.targets.size() == target_count &&
                same_geometry(*w.primitive, primitive))
                return w;
        PrimitiveWriter writer(document_, primitive, radii, alpha);
        Written& w = candidates.emplace_back(
            Written{&primitive, alpha, writer.attributes(), Json::array(), writer.indices()});
        for (size_t t = 0; t < target_count; ++t)
            w.targets.push_back(writer.target(primitive.targets.at(t)));
        return w;
    }

    Document& document_;
    std::set<std::string>& lost_;
    std::map<std::pair<size_t, size_t>, std::vector<Written>> written_;
};

/// What core glTF allows for an attribute; anything else asks for KHR_mesh_quantization.
bool is_plain(const std::string& name, const Json& accessor) {
    const int type = integer(accessor, "componentType");
    const bool small = type == kUnsignedByte || type == kUnsignedShort;
    const bool normalized = accessor.value("normalized", false);
    if (type == kFloat || name.starts_with("_") || name.starts_with("JOINTS_")) return true;
    return small && normalized && name != "POSITION" && name != "NORMAL" && name != "TANGENT";
}

bool is_quantized(const Document& document) {
    const auto any = [&](const Json& attributes) {
        for (const auto& [name, accessor] : attributes.items())
            if (!is_plain(name, document.json.at("accessors").at(accessor.get<size_t>())))
                return true;
        return false;
    };
    for (const Json& mesh : list_of(document.json, "meshes"))
        for (const Json& primitive : list_of(mesh, "primitives")) {
            if (any(primitive.at("attributes"))) return true;
            for (const Json& target : list_of(primitive, "targets"))
                if (any(target)) return true;
        }
    return false;
}

}  // namespace

Status replace_meshes(Document& document, const Scene& scene, const SplatRadii& splats,
                      std::vector<std::string>& warnings) {
    drop_meshopt(document);
    if (list_of(document.json, "meshes").size() != scene.meshes.size())
        return fail(Errc::malformed, "the file has other meshes than the scene");
    std::set<std::string> lost;
    Replacer replacer(document, lost);
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const auto& primitives = scene.meshes[m].primitives;
        Json& list = document.json["meshes"][m]["primitives"];
        if (list.size() != primitives.size())
            return fail(Errc::malformed, fmt::format("mesh {} \"{}\" has other primitives than "
                                                     "the scene's",
                                                     m, scene.meshes[m].name));
        for (size_t p = 0; p < primitives.size(); ++p) {
            if (primitives[p].triangles.empty()) continue;
            Json json = list[p];
            replacer.replace(json, primitives[p],
                             splats.empty() ? std::span<const float>() : splats[m][p]);
            document.json["meshes"][m]["primitives"][p] = std::move(json);
        }
    }
    drop_extension_if_unused(document, kDraco);
    if (!is_quantized(document)) drop_extension_if_unused(document, kQuantization);
    if (!lost.empty())
        warnings.push_back(fmt::format("attributes that are not kept: {}", fmt::join(lost, ", ")));
    return {};
}

}  // namespace aglow::gltf::edit
