// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/decompress.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstring>

namespace aglow::gltf::edit {
namespace {

Result<std::span<const uint8_t>> compressed_bytes(const Document& document, const Json& extension) {
    const Json& view = document.json.at("bufferViews").at(extension.at("bufferView").get<size_t>());
    const auto buffer = document.buffer(view.at("buffer").get<size_t>());
    const size_t offset = view.value("byteOffset", size_t{0});
    const size_t length = view.at("byteLength").get<size_t>();
    if (offset > buffer.size() || length > buffer.size() - offset)
        return fail(Errc::malformed, "Draco data leaves its buffer");
    return buffer.subspan(offset, length);
}

template <class T>
bool convert(const draco::PointAttribute& attribute, draco::AttributeValueIndex value,
             size_t components, uint8_t* out) {
    T numbers[16] = {};
    if (!attribute.ConvertValue<T>(value, static_cast<int8_t>(components), numbers)) return false;
    std::memcpy(out, numbers, components * sizeof(T));
    return true;
}

bool convert_to(int component_type, const draco::PointAttribute& attribute,
                draco::AttributeValueIndex value, size_t components, uint8_t* out) {
    switch (component_type) {
        case 5120:
            return convert<int8_t>(attribute, value, components, out);
        case 5121:
            return convert<uint8_t>(attribute, value, components, out);
        case 5122:
            return convert<int16_t>(attribute, value, components, out);
        case kUnsignedShort:
            return convert<uint16_t>(attribute, value, components, out);
        case kUnsignedInt:
            return convert<uint32_t>(attribute, value, components, out);
        default:
            return convert<float>(attribute, value, components, out);
    }
}

Result<Elements> attribute_elements(const draco::Mesh& mesh, const Json& accessor, uint32_t id) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
    if (!attribute) return fail(Errc::malformed, fmt::format("no Draco attribute {}", id));
    Elements elements;
    elements.component_type = integer(accessor, "componentType");
    elements.type = accessor.at("type").get<std::string>();
    elements.size = element_size(elements.component_type, elements.type);
    elements.count = mesh.num_points();
    const size_t component = element_size(elements.component_type, "SCALAR");
    if (elements.size == 0 || elements.type.starts_with("MAT"))
        return fail(Errc::malformed, "a Draco attribute of unknown type");
    elements.bytes.resize(elements.count * elements.size);
    for (size_t i = 0; i < elements.count; ++i) {
        const auto value = attribute->mapped_index(draco::PointIndex(static_cast<uint32_t>(i)));
        if (value.value() >= attribute->size() ||
            !convert_to(elements.component_type, *attribute, value, elements.size / component,
                        elements.bytes.data() + i * elements.size))
            return fail(Errc::malformed, "a Draco attribute does not fit its accessor");
    }
    return elements;
}

}  // namespace

Result<std::map<std::string, Elements>> decode_draco(const Document& document,
                                                     const Json& primitive) {
    const Json& extension = *find_extension(primitive, "KHR_draco_mesh_compression");
    AG_TRY(const auto bytes, compressed_bytes(document, extension));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return fail(Errc::malformed, "Draco data is damaged");
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

    std::map<std::string, Elements> attributes;
    for (const auto& [name, id] : extension.at("attributes").items()) {
        const auto accessor = primitive.at("attributes").find(name);
        if (accessor == primitive.at("attributes").end()) continue;
        const Json& json = document.json.at("accessors").at(accessor->get<size_t>());
        AG_TRY(attributes[name], attribute_elements(*mesh, json, id.get<uint32_t>()));
    }
    return attributes;
}

}  // namespace aglow::gltf::edit
