// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace aglow::gltf {
namespace {

constexpr size_t kMaxSetNumber = 63;  // no writer comes near; a name must not ask for memory

/// The n of `prefix` n, if the name is of that form.
std::optional<size_t> set_number(std::string_view name, std::string_view prefix) {
    if (!name.starts_with(prefix)) return std::nullopt;
    name.remove_prefix(prefix.size());
    if (name.empty() || name.size() > 2) return std::nullopt;
    size_t number = 0;
    for (const char c : name) {
        if (c < '0' || c > '9') return std::nullopt;
        number = 10 * number + static_cast<size_t>(c - '0');
    }
    return number <= kMaxSetNumber ? std::optional(number) : std::nullopt;
}

/// Attributes that are read; the others (tangents, custom ones) stay compressed.
bool is_read(std::string_view name) {
    return name == "POSITION" || name == "NORMAL" || name == "COLOR_0" || name == "_SHARPNESS" ||
           name == "_TENSION" || name == "_BIAS" || set_number(name, "TEXCOORD_") ||
           set_number(name, "JOINTS_") || set_number(name, "WEIGHTS_");
}

Result<DracoRequest> read_request(const Json& primitive, const Json& compressed,
                                  const Json& attributes, const Accessors& accessors,
                                  const std::string& name) {
    AG_TRY(const uint64_t id, compressed.required_size(name.c_str()));
    if (id > std::numeric_limits<uint32_t>::max())
        return primitive.wrong(fmt::format("Draco attribute {} does not exist", id));
    AG_TRY(const int index, attributes.required_index(name.c_str(), accessors.size(), "accessor"));
    const Accessor& accessor = accessors[index];
    return DracoRequest{name, static_cast<uint32_t>(id), accessor.components,
                        accessor.normalized ? normalizer(accessor.type) : 1.0f};
}

}  // namespace

Result<std::optional<DracoPrimitive>> read_draco(const Json& primitive, const Json& attributes,
                                                 std::span<const BufferView> views,
                                                 Accessors& accessors) {
    AG_TRY(const Json extension, primitive.extension("KHR_draco_mesh_compression"));
    if (!extension.exists()) return std::optional<DracoPrimitive>();
    AG_TRY(const int view, extension.required_index("bufferView", views.size(), "bufferView"));
    AG_TRY(const Json compressed, extension.object("attributes"));
    DracoPrimitive result;
    std::vector<DracoRequest> requests;
    for (const std::string& name : compressed.keys()) {
        if (!is_read(name)) continue;
        AG_TRY(DracoRequest request,
               read_request(primitive, compressed, attributes, accessors, name));
        result.names.push_back(name);
        requests.push_back(std::move(request));
    }
    AG_TRY(result.mesh,
           decode_draco(views[static_cast<size_t>(view)].bytes, requests, primitive.element()));
    AG_CHECK(accessors.charge(result.mesh.indices.size(), primitive.element()));
    for (const DracoRequest& request : requests)
        AG_CHECK(
            accessors.charge(result.mesh.vertex_count * static_cast<uint64_t>(request.components),
                             primitive.element()));
    return std::optional(std::move(result));
}

size_t AttributeReader::set_count(std::string_view prefix) const {
    size_t count = 0;
    for (const std::string& name : attributes_.keys())
        if (const auto number = set_number(name, prefix)) count = std::max(count, *number + 1);
    return count;
}

Result<std::vector<float>> AttributeReader::read(const std::string& name,
                                                 std::initializer_list<int> widths) {
    AG_TRY(const int index, attributes_.index(name.c_str(), accessors_.size(), "accessor"));
    if (index < 0) return std::vector<float>();
    const Accessor& accessor = accessors_[index];
    if (accessor.matrix ||
        std::find(widths.begin(), widths.end(), accessor.components) == widths.end())
        return attributes_.wrong(
            fmt::format("{} ({}) must be of type {}", name, accessor.element,
                        *widths.begin() == 1 ? "SCALAR" : fmt::format("VEC{}", *widths.begin())));
    if (!count_) count_ = accessor.count;
    if (accessor.count != *count_)
        return attributes_.wrong(fmt::format("{} ({}) has {} elements, not {}", name,
                                             accessor.element, accessor.count, *count_));
    if (draco_) {
        const auto at = std::find(draco_->names.begin(), draco_->names.end(), name);
        if (at != draco_->names.end())
            return draco_->mesh.values[static_cast<size_t>(at - draco_->names.begin())];
    }
    return accessors_.floats(index);
}

}  // namespace aglow::gltf
