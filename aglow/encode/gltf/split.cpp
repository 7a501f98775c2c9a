// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/split.h"

#include "aglow/scene/gltf/edit/decompress.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace aglow::encode {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Which vertices of a primitive are written, and what the file calls them.
struct Selection {
    std::vector<uint32_t> kept;     ///< vertices of the Primitive, increasing
    std::vector<uint32_t> sources;  ///< [kept] the file's vertex each is a copy of
    std::vector<uint32_t> indices;  ///< [3 * triangles] into kept
};

/// Vertices no triangle uses are left out.
Selection select(const Primitive& primitive) {
    std::vector<uint32_t> place(primitive.positions.size(), 0);
    for (const uvec3 t : primitive.triangles) place[t.x] = place[t.y] = place[t.z] = 1;
    Selection selection;
    for (uint32_t v = 0; v < place.size(); ++v) {
        if (place[v] == 0) continue;
        place[v] = static_cast<uint32_t>(selection.kept.size());
        selection.kept.push_back(v);
        const bool split = !primitive.source_vertex.empty();
        selection.sources.push_back(split ? primitive.source_vertex[v] : v);
    }
    selection.indices.reserve(3 * primitive.triangles.size());
    for (const uvec3 t : primitive.triangles) {
        for (const uint32_t corner : {t.x, t.y, t.z}) selection.indices.push_back(place[corner]);
    }
    return selection;
}

/// Writes accessors anew, one primitive at a time; one that is used twice is written once.
class Rewriter {
public:
    Rewriter(Document& document, const Selection& selection,
             std::map<std::string, Elements> decoded)
        : document_(document), selection_(selection), decoded_(std::move(decoded)) {}

    /// `decode` says that the names are those of the primitive's own attributes, which may have
    /// been compressed; morph targets never are.
    Status rewrite(Json& attributes, bool decode) {
        for (auto& [name, accessor] : attributes.items()) {
            const int old = accessor.get<int>();
            if (!written_.contains(old)) {
                AG_TRY(const int written, write(name, old, decode));
                written_[old] = written;
            }
            accessor = written_[old];
            release_accessor(document_, old);
        }
        return {};
    }

private:
    Result<int> write(const std::string& name, int old, bool decode) {
        const auto decoded = decoded_.find(name);
        Elements elements;
        if (decode && decoded != decoded_.end()) {
            elements = std::move(decoded->second);
        } else {
            AG_TRY(elements, read_elements(document_, old));
        }
        for (const uint32_t source : selection_.sources) {
            if (source >= elements.count)
                return fail(Errc::malformed, fmt::format("{} has no vertex {}", name, source));
        }
        const Json like = document_.json.at("accessors").at(static_cast<size_t>(old));
        return add_gathered(document_, elements, selection_.sources, like, name == "POSITION");
    }

    Document& document_;
    const Selection& selection_;
    std::map<std::string, Elements> decoded_;
    std::map<int, int> written_;
};

/// Gives the first `width` numbers of an entry, vertices of the file, the numbers of one of their
/// copies. Result: whether all have one.
bool renumber_entry(Json& entry, size_t width, const std::map<double, size_t>& place) {
    for (size_t i = 0; i < std::min(width, entry.size()); ++i) {
        Json& vertex = entry.at(i);
        if (!vertex.is_number()) continue;
        const auto at = place.find(vertex.get<double>());
        if (at == place.end()) return false;
        vertex = at->second;
    }
    return true;
}

/// The lists of extras that name vertices: docs/formats/creases.md.
void renumber_tags(Json& json, const Selection& selection) {
    if (!json.contains("extras") || !json.at("extras").is_object()) return;
    Json& extras = json.at("extras");
    std::map<double, size_t> place;
    for (size_t i = 0; i < selection.sources.size(); ++i) place.emplace(selection.sources[i], i);
    for (const auto& [key, width] : {std::pair{"creases", size_t{2}}, {"corners", size_t{1}}}) {
        if (!extras.contains(key) || !extras.at(key).is_array()) continue;
        Json kept = Json::array();
        for (Json& entry : extras.at(key))
            if (!entry.is_array() || renumber_entry(entry, width, place))
                kept.push_back(std::move(entry));
        extras[key] = std::move(kept);
    }
}

void drop_draco(Document& document, Json& json) {
    const Json* draco = find_extension(json, kDraco);
    if (!draco) return;
    const int view = integer(*draco, "bufferView");
    erase_extension(json, kDraco);
    release_view(document, view);
}

std::vector<uint32_t> all_vertices(const Primitive& primitive) {
    std::vector<uint32_t> vertices(primitive.positions.size());
    std::iota(vertices.begin(), vertices.end(), 0u);
    return vertices;
}

}  // namespace

Result<std::vector<uint32_t>> split_vertices(Document& document, Json& json,
                                             const Primitive& primitive) {
    const bool compressed = find_extension(json, kDraco) != nullptr;
    if (primitive.source_vertex.empty() && !compressed) return all_vertices(primitive);

    Selection selection = select(primitive);
    std::map<std::string, Elements> decoded;
    if (compressed) {
        AG_TRY(decoded, decode_draco(document, json));
    }
    Rewriter rewriter(document, selection, std::move(decoded));
    AG_CHECK(rewriter.rewrite(json.at("attributes"), true));
    if (json.contains("targets")) {
        for (Json& target : json.at("targets")) AG_CHECK(rewriter.rewrite(target, false));
    }
    renumber_tags(json, selection);
    drop_draco(document, json);

    const int old_indices = integer(json, "indices");
    json["indices"] = add_indices(document, selection.indices, selection.kept.size());
    release_accessor(document, old_indices);
    json.erase("mode");  // a triangle list is the default
    return std::move(selection.kept);
}

}  // namespace aglow::encode
