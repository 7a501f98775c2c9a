// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace aglow::gltf {
namespace {

struct Shape {
    const char* name;
    int components;
    bool matrix;
};
constexpr Shape kShapes[] = {{"SCALAR", 1, false}, {"VEC2", 2, false}, {"VEC3", 3, false},
                             {"VEC4", 4, false},   {"MAT2", 4, true},  {"MAT3", 9, true},
                             {"MAT4", 16, true}};

Result<ComponentType> read_type(const Json& json) {
    AG_TRY(const uint64_t type, json.required_size("componentType"));
    const bool known = type >= 5120 && type <= 5126 && type != 5124;
    if (!known) return json.wrong(fmt::format("componentType {} does not exist", type));
    return static_cast<ComponentType>(type);
}

/// Columns of matrices start at multiples of four bytes (glTF 2.0, section 3.6.2.4).
size_t element_bytes(const Accessor& accessor) {
    const size_t size = component_bytes(accessor.type);
    const size_t components = static_cast<size_t>(accessor.components);
    if (!accessor.matrix) return size * components;
    const size_t rows = components == 4 ? 2 : components == 9 ? 3 : 4;
    return (rows * size + 3) / 4 * 4 * (components / rows);
}

/// The bytes of `count` elements of `size` bytes, `stride` apart, from `offset` of a view on.
std::optional<std::span<const uint8_t>> slice(std::span<const uint8_t> view, uint64_t offset,
                                              uint64_t count, size_t size, size_t stride) {
    if (offset > view.size()) return std::nullopt;
    const uint64_t available = view.size() - offset;
    if (count == 0) return view.first(0);
    if (size > available || count - 1 > (available - size) / stride) return std::nullopt;
    return view.subspan(static_cast<size_t>(offset),
                        static_cast<size_t>((count - 1) * stride + size));
}

Status read_place(const Json& json, std::span<const BufferView> views, Accessor& accessor) {
    const size_t size = element_bytes(accessor);
    accessor.stride = size;
    AG_TRY(const int index, json.index("bufferView", views.size(), "bufferView"));
    if (index < 0) return {};
    const BufferView& view = views[static_cast<size_t>(index)];
    AG_TRY(const uint64_t offset, json.size("byteOffset", 0));
    if (view.stride != 0) accessor.stride = view.stride;
    if (accessor.stride < size)
        return json.wrong(fmt::format("byteStride {} of bufferView {} is less than an element's {}",
                                      view.stride, index, size));
    const auto bytes = slice(view.bytes, offset, accessor.count, size, accessor.stride);
    if (!bytes)
        return json.wrong(fmt::format("{} elements exceed bufferView {}", accessor.count, index));
    accessor.bytes = *bytes;
    return {};
}

Result<std::span<const uint8_t>> read_sparse_array(const Json& json,
                                                   std::span<const BufferView> views,
                                                   uint64_t count, size_t size) {
    if (!json.exists()) return json.wrong("sparse indices or values are missing");
    AG_TRY(const int index, json.required_index("bufferView", views.size(), "bufferView"));
    AG_TRY(const uint64_t offset, json.size("byteOffset", 0));
    const auto bytes = slice(views[static_cast<size_t>(index)].bytes, offset, count, size, size);
    if (!bytes)
        return json.wrong(fmt::format("{} sparse elements exceed bufferView {}", count, index));
    return *bytes;
}

Status read_sparse(const Json& json, std::span<const BufferView> views, Accessor& accessor) {
    AG_TRY(const Json sparse, json.object("sparse"));
    if (!sparse.exists()) return {};
    AG_TRY(const uint64_t count, sparse.required_size("count"));
    if (count > accessor.count) return json.wrong("sparse count exceeds count");
    AG_TRY(const Json indices, sparse.object("indices"));
    AG_TRY(const Json values, sparse.object("values"));
    if (!indices.exists()) return json.wrong("sparse.indices is missing");
    AG_TRY(accessor.sparse.index_type, read_type(indices));
    const ComponentType type = accessor.sparse.index_type;
    if (type != ComponentType::u8 && type != ComponentType::u16 && type != ComponentType::u32)
        return json.wrong("sparse indices must be unsigned integers");
    AG_TRY(accessor.sparse.indices,
           read_sparse_array(indices, views, count, component_bytes(type)));
    AG_TRY(accessor.sparse.values,
           read_sparse_array(values, views, count, element_bytes(accessor)));
    accessor.sparse.count = static_cast<size_t>(count);
    return {};
}

Result<Accessor> read_accessor(const Json& json, std::span<const BufferView> views) {
    Accessor accessor;
    accessor.element = json.element();
    AG_TRY(accessor.type, read_type(json));
    AG_TRY(const std::string type, json.text("type", ""));
    const auto shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return type == s.name; });
    if (shape == std::end(kShapes))
        return json.wrong(fmt::format("type \"{}\" does not exist", type.substr(0, 20)));
    accessor.components = shape->components;
    accessor.matrix = shape->matrix;
    AG_TRY(accessor.normalized, json.boolean("normalized", false));
    AG_TRY(const uint64_t count, json.required_size("count"));
    // Element numbers are 32-bit integers everywhere.
    if (count >= std::numeric_limits<uint32_t>::max())
        return json.wrong(fmt::format("count {} is too large", count));
    accessor.count = static_cast<size_t>(count);
    AG_CHECK(read_place(json, views, accessor));
    AG_CHECK(read_sparse(json, views, accessor));
    return accessor;
}

/// Glue for reads at any alignment. Like the file, the machine is little-endian.
template <class T>
T load(const uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

template <class Out>
Out component(const uint8_t* at, ComponentType type) {
    switch (type) {
        case ComponentType::i8:
            return static_cast<Out>(load<int8_t>(at));
        case ComponentType::u8:
            return static_cast<Out>(load<uint8_t>(at));
        case ComponentType::i16:
            return static_cast<Out>(load<int16_t>(at));
        case ComponentType::u16:
            return static_cast<Out>(load<uint16_t>(at));
        case ComponentType::u32:
            return static_cast<Out>(load<uint32_t>(at));
        case ComponentType::f32:
            break;
    }
    return static_cast<Out>(load<float>(at));
}

/// Decodes one element to out[0 .. components).
template <class Out>
void read_element(const Accessor& accessor, const uint8_t* at, Out* out) {
    const size_t size = component_bytes(accessor.type);
    const int components = accessor.components;
    const int rows = !accessor.matrix ? components : components == 4 ? 2 : components == 9 ? 3 : 4;
    const size_t column_bytes =
        accessor.matrix ? (static_cast<size_t>(rows) * size + 3) / 4 * 4 : 0;
    for (int i = 0; i < components; ++i) {
        const size_t offset =
            static_cast<size_t>(i / rows) * column_bytes + static_cast<size_t>(i % rows) * size;
        out[i] = component<Out>(at + offset, accessor.type);
    }
}

template <class Out>
Result<std::vector<Out>> decode(const Accessor& accessor) {
    const size_t width = static_cast<size_t>(accessor.components);
    std::vector<Out> out(accessor.count * width);
    if (!accessor.bytes.empty())
        for (size_t i = 0; i < accessor.count; ++i)
            read_element(accessor, accessor.bytes.data() + i * accessor.stride, &out[i * width]);
    const SparsePart& sparse = accessor.sparse;
    const size_t index_bytes = component_bytes(sparse.index_type);
    const size_t value_bytes = element_bytes(accessor);
    for (size_t k = 0; k < sparse.count; ++k) {
        const size_t i =
            component<uint32_t>(sparse.indices.data() + k * index_bytes, sparse.index_type);
        if (i >= accessor.count)
            return fail(Errc::malformed, fmt::format("{}: sparse index {} is not below count {}",
                                                     accessor.element, i, accessor.count));
        read_element(accessor, sparse.values.data() + k * value_bytes, &out[i * width]);
    }
    return out;
}

}  // namespace

size_t component_bytes(ComponentType type) {
    switch (type) {
        case ComponentType::i8:
        case ComponentType::u8:
            return 1;
        case ComponentType::i16:
        case ComponentType::u16:
            return 2;
        case ComponentType::u32:
        case ComponentType::f32:
            break;
    }
    return 4;
}

float normalizer(ComponentType type) {
    switch (type) {
        case ComponentType::i8:
            return 127.0f;
        case ComponentType::u8:
            return 255.0f;
        case ComponentType::i16:
            return 32767.0f;
        case ComponentType::u16:
            return 65535.0f;
        case ComponentType::u32:
            return 4294967295.0f;
        case ComponentType::f32:
            break;
    }
    return 1.0f;
}

Result<Accessors> Accessors::read(const Json& root, std::span<const BufferView> views,
                                  size_t file_bytes) {
    // Numbers a file of any size may expand to, and numbers per byte of it: vertices shared by
    // hundreds of primitives and Draco's best ratios stay below.
    constexpr uint64_t kFreeNumbers = 1 << 24;
    constexpr uint64_t kNumbersPerByte = 256;
    AG_TRY(const std::vector<Json> list, elements(root, "accessors", "accessor"));
    Accessors accessors;
    accessors.budget_ = kFreeNumbers + kNumbersPerByte * file_bytes;
    for (const Json& json : list) {
        AG_TRY(Accessor accessor, read_accessor(json, views));
        accessors.list_.push_back(std::move(accessor));
    }
    return accessors;
}

Status Accessors::charge(uint64_t numbers, const std::string& element) {
    if (numbers > budget_)
        return fail(
            Errc::out_of_memory,
            fmt::format("{}: decodes to far more numbers than the file has bytes", element));
    budget_ -= numbers;
    return {};
}

Result<std::vector<float>> Accessors::floats(int i) {
    const Accessor& accessor = (*this)[i];
    AG_CHECK(charge(accessor.count * static_cast<uint64_t>(accessor.components), accessor.element));
    AG_TRY(std::vector<float> values, decode<float>(accessor));
    if (accessor.normalized && accessor.type != ComponentType::f32) {
        const float one = normalizer(accessor.type);
        for (float& v : values) v = std::max(v / one, -1.0f);
    }
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
    if (bad != values.end())
        return fail(Errc::malformed, fmt::format("{}: element {} is not finite", accessor.element,
                                                 (bad - values.begin()) / accessor.components));
    return values;
}

Result<std::vector<uint32_t>> Accessors::uints(int i) {
    const Accessor& accessor = (*this)[i];
    const bool is_unsigned = accessor.type == ComponentType::u8 ||
                             accessor.type == ComponentType::u16 ||
                             accessor.type == ComponentType::u32;
    if (!is_unsigned || accessor.normalized)
        return fail(Errc::malformed, accessor.element + ": must hold unsigned integers");
    AG_CHECK(charge(accessor.count * static_cast<uint64_t>(accessor.components), accessor.element));
    return decode<uint32_t>(accessor);
}

}  // namespace aglow::gltf
