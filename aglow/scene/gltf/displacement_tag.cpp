// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/displacement_tag.h"

#include "aglow/scene/gltf/uri.h"

#include <fmt/format.h>

namespace aglow::gltf {
namespace {

Result<DisplacementRef> read_tag(const Json& tag, size_t set_count) {
    DisplacementRef found;
    AG_TRY(const std::string uri, tag.text("uri", ""));
    if (uri.empty()) return tag.wrong("names no uri");
    Result<std::filesystem::path> path = relative_path(uri);
    if (!path) return tag.wrong(path.error().message);
    found.file = *path;
    AG_TRY(const uint64_t set, tag.size("texCoord", 0));
    if (set >= set_count) return tag.wrong(fmt::format("TEXCOORD_{} does not exist", set));
    found.texcoord = static_cast<int>(set);
    AG_TRY(found.scale, tag.number("scale", found.scale));
    AG_TRY(found.bias, tag.number("bias", found.bias));
    return found;
}

}  // namespace

void read_displacement_tag(const Json& json, Primitive& primitive,
                           std::vector<std::string>& warnings) {
    const Result<Json> extras = json.object("extras");
    if (!extras || !extras->exists() || !extras->has("displacement")) return;
    const auto leave_out = [&](const Error& error) {
        warnings.push_back(error.message + "; the displacement is left out");
    };
    const Result<Json> tag = extras->object("displacement");
    if (!tag) return leave_out(tag.error());
    const Result<DisplacementRef> found = read_tag(
        tag->named(extras->element() + ": extras.displacement"), primitive.texcoords.size());
    if (!found) return leave_out(found.error());
    primitive.displacement = *found;
}

}  // namespace aglow::gltf
