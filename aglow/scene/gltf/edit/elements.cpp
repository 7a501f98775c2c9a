// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace aglow::gltf::edit {
namespace {

size_t component_size(int component_type) {
    switch (component_type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case kUnsignedShort:
            return 2;
        case kUnsignedInt:
        case kFloat:
            return 4;
        default:
            return 0;
    }
}

size_t component_count(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

uint64_t unsigned_member(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? 0 : found->get<uint64_t>();
}

/// Bytes [offset, offset + length) of a bufferView, or nothing where they leave it.
std::span<const uint8_t> view_bytes(const Document& document, const Json& view, uint64_t offset,
                                    uint64_t length) {
    const auto buffer = document.buffer(unsigned_member(view, "buffer"));
    const uint64_t start = unsigned_member(view, "byteOffset");
    const uint64_t extent = unsigned_member(view, "byteLength");
    if (start > buffer.size() || extent > buffer.size() - start) return {};
    if (offset > extent || length > extent - offset) return {};
    return buffer.subspan(start + offset, length);
}

const Json& view_of(const Document& document, const Json& object) {
    return document.json.at("bufferViews").at(object.at("bufferView").get<size_t>());
}

Status read_dense(const Document& document, const Json& accessor, Elements& elements) {
    if (!accessor.contains("bufferView") || elements.count == 0) return {};
    const Json& view = view_of(document, accessor);
    uint64_t stride = unsigned_member(view, "byteStride");
    if (stride == 0) stride = elements.size;
    if (stride > 255 && stride != elements.size) return fail(Errc::malformed, "stride above 255");
    const uint64_t length = (elements.count - 1) * stride + elements.size;
    const auto bytes = view_bytes(document, view, unsigned_member(accessor, "byteOffset"), length);
    if (bytes.empty()) return fail(Errc::malformed, "data leaves its bufferView");
    for (size_t i = 0; i < elements.count; ++i) {
        std::memcpy(elements.bytes.data() + i * elements.size, bytes.data() + i * stride,
                    elements.size);
    }
    return {};
}

uint32_t index_at(std::span<const uint8_t> bytes, size_t i, size_t size) {
    uint32_t index = 0;  // glTF and the machines this runs on are little-endian
    std::memcpy(&index, bytes.data() + i * size, size);
    return index;
}

Status read_sparse(const Document& document, const Json& accessor, Elements& elements) {
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end()) return {};
    const uint64_t count = unsigned_member(*sparse, "count");
    if (count > elements.count) return fail(Errc::malformed, "sparse count exceeds count");
    const Json& indices = sparse->at("indices");
    const Json& values = sparse->at("values");
    const size_t index_size = component_size(integer(indices, "componentType"));
    const auto index_bytes = view_bytes(document, view_of(document, indices),
                                        unsigned_member(indices, "byteOffset"), count * index_size);
    const auto value_bytes =
        view_bytes(document, view_of(document, values), unsigned_member(values, "byteOffset"),
                   count * elements.size);
    if (count != 0 && (index_bytes.empty() || value_bytes.empty()))
        return fail(Errc::malformed, "sparse data leaves its bufferView");
    for (size_t i = 0; i < count; ++i) {
        const uint32_t target = index_at(index_bytes, i, index_size);
        if (target >= elements.count) return fail(Errc::malformed, "sparse index out of range");
        std::memcpy(elements.bytes.data() + target * elements.size,
                    value_bytes.data() + i * elements.size, elements.size);
    }
    return {};
}

template <class T>
void bounds_of(std::span<const uint8_t> bytes, size_t size, size_t components, Json& accessor) {
    std::vector<T> lo(components), hi(components);
    for (size_t at = 0; at < bytes.size(); at += size) {
        for (size_t c = 0; c < components; ++c) {
            T value{};
            std::memcpy(&value, bytes.data() + at + c * sizeof(T), sizeof(T));
            lo[c] = at == 0 ? value : std::min(lo[c], value);
            hi[c] = at == 0 ? value : std::max(hi[c], value);
        }
    }
    accessor["min"] = lo;
    accessor["max"] = hi;
}

void write_bounds(std::span<const uint8_t> bytes, size_t size, const Elements& elements,
                  Json& accessor) {
    const size_t components = component_count(elements.type);
    switch (elements.component_type) {
        case 5120:
            return bounds_of<int8_t>(bytes, size, components, accessor);
        case 5121:
            return bounds_of<uint8_t>(bytes, size, components, accessor);
        case 5122:
            return bounds_of<int16_t>(bytes, size, components, accessor);
        case kUnsignedShort:
            return bounds_of<uint16_t>(bytes, size, components, accessor);
        case kUnsignedInt:
            return bounds_of<uint32_t>(bytes, size, components, accessor);
        default:
            return bounds_of<float>(bytes, size, components, accessor);
    }
}

template <class T>
std::span<const uint8_t> as_bytes(const std::vector<T>& values) {
    return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

size_t element_size(int component_type, std::string_view type) {
    const size_t component = component_size(component_type);
    // Matrix columns start on multiples of four bytes (glTF 2.0, 3.6.2.4).
    if (type == "MAT2") return 2 * ((2 * component + 3) / 4 * 4);
    if (type == "MAT3") return 3 * ((3 * component + 3) / 4 * 4);
    return component * component_count(type);
}

Result<Elements> read_elements(const Document& document, int accessor) {
    const Json& json = document.json.at("accessors").at(static_cast<size_t>(accessor));
    Elements elements;
    elements.component_type = integer(json, "componentType");
    elements.type = json.at("type").get<std::string>();
    elements.size = element_size(elements.component_type, elements.type);
    elements.count = json.at("count").get<size_t>();
    // The same bound that loading sets; it keeps accessors without data from taking all memory.
    constexpr size_t kMaxCount = size_t{1} << 28;
    Status status;
    if (elements.size == 0) status = fail(Errc::malformed, "unknown type");
    if (elements.count > kMaxCount) status = fail(Errc::malformed, "more than 2^28 elements");
    if (status) {
        elements.bytes.resize(elements.count * elements.size);
        status = read_dense(document, json, elements);
    }
    if (status) status = read_sparse(document, json, elements);
    if (!status)
        return fail(status.error().code,
                    fmt::format("accessor {}: {}", accessor, status.error().message));
    return elements;
}

int add_gathered(Document& document, const Elements& elements, std::span<const uint32_t> vertices,
                 const Json& like, bool bounds) {
    // Vertex attributes start on multiples of four bytes.
    const size_t stride = (elements.size + 3) / 4 * 4;
    std::vector<uint8_t> bytes(vertices.size() * stride);
    for (size_t i = 0; i < vertices.size(); ++i) {
        std::memcpy(bytes.data() + i * stride, elements.bytes.data() + vertices[i] * elements.size,
                    elements.size);
    }
    Json accessor = like;
    for (const char* key : {"byteOffset", "sparse", "min", "max"}) accessor.erase(key);
    accessor["bufferView"] = add_view(document, bytes, kVertexTarget,
                                      stride == elements.size ? 0 : static_cast<int>(stride));
    accessor["componentType"] = elements.component_type;
    accessor["count"] = vertices.size();
    if (bounds || like.contains("min")) write_bounds(bytes, stride, elements, accessor);
    return add_accessor(document, std::move(accessor));
}

int add_floats(Document& document, std::span<const float> values, const char* type, int target) {
    const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(values.data()),
                                         values.size_bytes());
    const int view = add_view(document, bytes, target);
    return add_accessor(document,
                        Json{{"bufferView", view},
                             {"componentType", kFloat},
                             {"count", values.size() / std::max(size_t{1}, component_count(type))},
                             {"type", type}});
}

int add_indices(Document& document, std::span<const uint32_t> indices, size_t vertex_count) {
    // The largest number of each type is reserved for primitive restart.
    const bool narrow = vertex_count < 0xffff;
    const std::vector<uint16_t> narrowed(narrow ? indices.begin() : indices.end(), indices.end());
    const std::span<const uint8_t> wide(reinterpret_cast<const uint8_t*>(indices.data()),
                                        indices.size_bytes());
    const int view = add_view(document, narrow ? as_bytes(narrowed) : wide, kIndexTarget);
    return add_accessor(document, Json{{"bufferView", view},
                                       {"componentType", narrow ? kUnsignedShort : kUnsignedInt},
                                       {"count", indices.size()},
                                       {"type", "SCALAR"}});
}

}  // namespace aglow::gltf::edit
