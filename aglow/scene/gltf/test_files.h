// SPDX-License-Identifier: Apache-2.0
// Makes small glTF files for tests.
#pragma once
#include "aglow/scene/gltf/json.h"
#include "aglow/scene/load.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::gltf_test {

using Bytes = std::vector<uint8_t>;

/// The bytes of `values`, one after the other.
template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void append_u32(Bytes& bytes, size_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<uint8_t>(value >> shift & 255));
}

/// A GLB file of a JSON text and a binary chunk.
inline Bytes glb(std::string json, Bytes binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, 0);
    Bytes file{'g', 'l', 'T', 'F', 2, 0, 0, 0};
    append_u32(file, 28 + json.size() + binary.size());
    append_u32(file, json.size());
    append_u32(file, 0x4E4F534A);
    append(file, Bytes(json.begin(), json.end()));
    append_u32(file, binary.size());
    append_u32(file, 0x004E4942);
    append(file, binary);
    return file;
}

inline Result<Scene> load(std::span<const uint8_t> file, const std::filesystem::path& folder = {}) {
    return load_gltf(std::as_bytes(file), "test.glb", folder);
}

inline Result<Scene> load_json(const std::string& json, const std::filesystem::path& folder = {}) {
    return load(Bytes(json.begin(), json.end()), folder);
}

/// `{"asset": {"version": "2.0"}, <members>}`
inline std::string document(std::string_view members) {
    return R"({"asset": {"version": "2.0"}, )" + std::string(members) + "}";
}

inline std::string base64(const Bytes& bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](size_t k) { return k < bytes.size() ? uint32_t{bytes[k]} : 0u; };
        const uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[bits >> shift & 63];
    }
    for (size_t missing = (3 - bytes.size() % 3) % 3; missing > 0; --missing)
        text[text.size() - missing] = '=';
    return text;
}

/// The unit right triangle in the xy plane: positions 0 (36 bytes), 16-bit indices at 36.
inline Bytes triangle_bytes() {
    Bytes bytes = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    append(bytes, bytes_of<uint16_t>({0, 1, 2, 0}));
    return bytes;
}

/// Members that describe triangle_bytes(): buffer 0 is the GLB chunk, accessors 0 (positions)
/// and 1 (indices).
inline constexpr const char* kTriangleBuffers = R"(
    "buffers": [{"byteLength": 44}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                  {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 3}])";
inline constexpr const char* kTriangleMesh =
    R"("meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}])";

/// The triangle as a whole file, with more members or others in place of its mesh.
inline Bytes triangle_file(const std::string& more = "", const std::string& mesh = kTriangleMesh) {
    const std::string members = std::string(kTriangleBuffers) + ", " + mesh + more;
    return glb(document(members), triangle_bytes());
}

/// A primitive, and what reading its extras warned of.
struct ExtrasRead {
    Primitive primitive;
    std::vector<std::string> warnings;
};

/// What `read(json, primitive, warnings)` makes of a primitive's JSON that has these extras.
template <class Read>
ExtrasRead read_extras(const Read& read, const std::string& extras, Primitive primitive) {
    ExtrasRead result{std::move(primitive), {}};
    const auto document = gltf::JsonDocument::parse(R"({"extras": )" + extras + "}");
    read(document.value().root().named("mesh 2 primitive 1"), result.primitive, result.warnings);
    return result;
}

}  // namespace aglow::gltf_test
