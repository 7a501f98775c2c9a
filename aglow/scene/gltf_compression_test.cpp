// SPDX-License-Identifier: Apache-2.0
// What the codecs' own encoders wrote reads back through the glTF extensions.
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf_source.h"

#include <doctest/doctest.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>
#include <meshoptimizer.h>
#include <webp/encode.h>
#include <algorithm>
#include <cmath>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

constexpr int kSide = 12;  // vertices along an edge of the test grid

/// A bumpy grid: vertices that no decoder could guess.
std::vector<vec3> grid_positions() {
    std::vector<vec3> positions;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const auto u = static_cast<float>(x), v = static_cast<float>(y);
            positions.push_back({u, v, std::sin(1.7f * u) * std::cos(2.3f * v)});
        }
    return positions;
}

std::vector<uint32_t> grid_indices() {
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y + 1 < kSide; ++y)
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            const uint32_t i = y * kSide + x;
            for (const uint32_t corner : {i, i + 1, i + kSide, i + kSide, i + 1, i + kSide + 1})
                indices.push_back(corner);
        }
    return indices;
}

/// Corners of all triangles as text, each triangle turned to start at its smallest: equal for
/// equal triangles whatever the order of vertices and triangles.
std::vector<std::string> triangle_set(const std::vector<vec3>& positions,
                                      const std::vector<uint32_t>& indices) {
    std::vector<std::string> set;
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        std::vector<std::string> corners;
        for (size_t k = 0; k < 3; ++k) {
            const vec3 p = positions[indices[t + k]];
            corners.push_back(fmt::format("{:.2f} {:.2f} {:.2f};", p.x, p.y, p.z + 0.001f));
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        set.push_back(corners[0] + corners[1] + corners[2]);
    }
    std::sort(set.begin(), set.end());
    return set;
}

std::vector<std::string> triangle_set(const Primitive& primitive) {
    std::vector<uint32_t> indices;
    for (const uvec3 t : primitive.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
    return triangle_set(primitive.positions, indices);
}

Bytes draco_bytes(uint32_t& position_id) {
    const auto positions = grid_positions();
    const auto indices = grid_indices();
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(indices.size() / 3));
    const int attribute =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (uint32_t t = 0; t < indices.size() / 3; ++t)
        builder.SetAttributeValuesForFace(
            attribute, draco::FaceIndex(t), &positions[indices[3 * t]].x,
            &positions[indices[3 * t + 1]].x, &positions[indices[3 * t + 2]].x);
    const auto mesh = builder.Finalize();
    position_id = mesh->attribute(attribute)->unique_id();
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return Bytes(buffer.data(), buffer.data() + buffer.size());
}

Bytes draco_file(size_t cut_bytes = 0, int id_offset = 0, int vertex_count = kSide * kSide) {
    uint32_t id = 0;
    Bytes bytes = draco_bytes(id);
    bytes.resize(bytes.size() - cut_bytes);
    const std::string json = document(fmt::format(
        R"("extensionsRequired": ["KHR_draco_mesh_compression"],
           "buffers": [{{"byteLength": {0}}}], "bufferViews": [{{"buffer": 0, "byteLength": {0}}}],
           "accessors": [{{"componentType": 5126, "type": "VEC3", "count": {1}}},
                         {{"componentType": 5125, "type": "SCALAR", "count": {2}}}],
           "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "extensions":
             {{"KHR_draco_mesh_compression": {{"bufferView": 0, "attributes": {{"POSITION": {3}}}}}}}}}]}}])",
        bytes.size(), vertex_count, grid_indices().size(), static_cast<int>(id) + id_offset));
    return glb(json, bytes);
}

/// The grid in a fallback buffer (1) that has no bytes, compressed in buffer 0.
struct MeshoptParts {
    Bytes vertices, indices;
    std::string json;
};

MeshoptParts meshopt_parts() {
    MeshoptParts parts;
    const auto positions = grid_positions();
    const auto indices = grid_indices();
    parts.vertices.resize(meshopt_encodeVertexBufferBound(positions.size(), 12));
    parts.vertices.resize(meshopt_encodeVertexBuffer(parts.vertices.data(), parts.vertices.size(),
                                                     positions.data(), positions.size(), 12));
    parts.indices.resize(meshopt_encodeIndexBufferBound(indices.size(), positions.size()));
    parts.indices.resize(meshopt_encodeIndexBuffer(parts.indices.data(), parts.indices.size(),
                                                   indices.data(), indices.size()));
    const size_t vertex_bytes = 12 * positions.size(), index_bytes = 2 * indices.size();
    parts.json = document(fmt::format(
        R"("extensionsRequired": ["EXT_meshopt_compression"],
           "buffers": [{{"byteLength": {0}}}, {{"byteLength": {1},
             "extensions": {{"EXT_meshopt_compression": {{"fallback": true}}}}}}],
           "bufferViews": [
             {{"buffer": 1, "byteLength": {2}, "extensions": {{"EXT_meshopt_compression":
               {{"buffer": 0, "byteLength": {3}, "byteStride": 12, "count": {4}, "mode": "ATTRIBUTES"}}}}}},
             {{"buffer": 1, "byteOffset": {2}, "byteLength": {5}, "extensions": {{"EXT_meshopt_compression":
               {{"buffer": 0, "byteOffset": {3}, "byteLength": {6}, "byteStride": 2, "count": {7}, "mode": "TRIANGLES"}}}}}}],
           "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": {4}}},
                         {{"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": {7}}}],
           "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}])",
        parts.vertices.size() + parts.indices.size(), vertex_bytes + index_bytes, vertex_bytes,
        parts.vertices.size(), positions.size(), index_bytes, parts.indices.size(),
        indices.size()));
    return parts;
}

Bytes join(const Bytes& a, const Bytes& b) {
    Bytes both = a;
    append(both, b);
    return both;
}

}  // namespace

TEST_CASE("Draco meshes have the triangles that were compressed") {
    const auto scene = load(draco_file());
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    CHECK(triangle_set(scene->meshes[0].primitives[0]) ==
          triangle_set(grid_positions(), grid_indices()));
}

TEST_CASE("broken Draco data is malformed") {
    for (const size_t cut : {1, 10, 100}) {
        const auto scene = load(draco_file(cut));
        REQUIRE_FALSE(scene.has_value());
        CHECK(scene.error().code == Errc::malformed);
    }
    const auto wrong_id = load(draco_file(0, 7));
    REQUIRE_FALSE(wrong_id.has_value());
    CHECK(wrong_id.error().message ==
          "mesh 0 primitive 0: Draco data has no attribute 7 for POSITION");
    const auto wrong_count = load(draco_file(0, 0, 5));
    REQUIRE_FALSE(wrong_count.has_value());
    CHECK(wrong_count.error().message ==
          "mesh 0 primitive 0: POSITION (accessor 0) has 5 elements, not 144");
}

TEST_CASE("meshopt buffers without a fallback read back bit for bit") {
    const MeshoptParts parts = meshopt_parts();
    const auto scene = load(glb(parts.json, join(parts.vertices, parts.indices)));
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    const Primitive& primitive = scene->meshes[0].primitives[0];
    CHECK(triangle_set(primitive) == triangle_set(grid_positions(), grid_indices()));
    // The fallback buffer holds what a writer needs that drops the extension.
    const Bytes& fallback = scene->source->buffers[1];
    const Bytes positions = bytes_of(grid_positions());
    REQUIRE(fallback.size() == positions.size() + 2 * grid_indices().size());
    CHECK(std::equal(positions.begin(), positions.end(), fallback.begin()));
}

TEST_CASE("meshopt data cut at any length is malformed") {
    const MeshoptParts parts = meshopt_parts();
    const std::string whole = fmt::format("\"byteLength\": {}", parts.vertices.size());
    const size_t at = parts.json.find(whole + ", \"byteStride\": 12");
    REQUIRE(at != std::string::npos);
    for (size_t length = 0; length < parts.vertices.size(); ++length) {
        std::string json = parts.json;
        json.replace(at, whole.size(), fmt::format("\"byteLength\": {}", length));
        const auto scene = load(glb(json, join(parts.vertices, parts.indices)));
        REQUIRE_FALSE(scene.has_value());
        CHECK(scene.error().code == Errc::malformed);
    }
    Bytes no_header = parts.vertices;
    no_header[0] = 0;
    const auto scene = load(glb(parts.json, join(no_header, parts.indices)));
    REQUIRE_FALSE(scene.has_value());
    CHECK(scene.error().message == "bufferView 0: compressed data does not decode");
}

TEST_CASE("meshopt's octahedral filter gives back unit normals to its precision") {
    // Normals of four floats each, filtered to four bytes, compressed.
    std::vector<float> normals;
    for (int i = 0; i < 16; ++i) {
        const float a = 0.4f * static_cast<float>(i), z = -0.9f + 0.11f * static_cast<float>(i);
        const float r = std::sqrt(1 - z * z);
        normals.insert(normals.end(), {r * std::cos(a), r * std::sin(a), z, 0});
    }
    Bytes filtered(16 * 4);
    meshopt_encodeFilterOct(filtered.data(), 16, 4, 8, normals.data());
    Bytes compressed(meshopt_encodeVertexBufferBound(16, 4));
    compressed.resize(
        meshopt_encodeVertexBuffer(compressed.data(), compressed.size(), filtered.data(), 16, 4));
    Bytes binary = compressed;
    binary.resize((binary.size() + 3) / 4 * 4);
    const size_t position_offset = binary.size();
    append(binary, bytes_of(std::vector<float>(48, 0.5f)));
    const std::string json = document(fmt::format(
        R"("buffers": [{{"byteLength": {0}}}, {{"byteLength": 64,
             "extensions": {{"EXT_meshopt_compression": {{"fallback": true}}}}}}],
           "bufferViews": [{{"buffer": 1, "byteLength": 64, "byteStride": 4,
               "extensions": {{"EXT_meshopt_compression": {{"buffer": 0, "byteLength": {1},
               "byteStride": 4, "count": 16, "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL"}}}}}},
             {{"buffer": 0, "byteOffset": {2}, "byteLength": 192}}],
           "accessors": [{{"bufferView": 0, "componentType": 5120, "normalized": true, "type": "VEC3", "count": 16}},
                         {{"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 16}}],
           "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 1, "NORMAL": 0}}}}]}}])",
        binary.size(), compressed.size(), position_offset));
    const auto scene = load(glb(json, binary));
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    const Primitive& primitive = scene->meshes[0].primitives[0];
    REQUIRE(primitive.normals.size() == 16);
    for (size_t i = 0; i < 16; ++i) {
        const vec3 expected{normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]};
        CHECK(length(primitive.normals[i] - expected) < 0.02f);  // two steps of 1/127
    }
}

TEST_CASE("the options of compressed views must fit each other") {
    const MeshoptParts parts = meshopt_parts();
    struct Change {
        const char *from, *to, *message;
    };
    const Change cases[] = {
        {"ATTRIBUTES", "POINTS", "bufferView 0: compression mode \"POINTS\" does not exist"},
        {"\"byteStride\": 12, \"count\": 144", "\"byteStride\": 6, \"count\": 288",
         "bufferView 0: byteStride 6 does not fit compression mode ATTRIBUTES"},
        {"\"count\": 144", "\"count\": 145",
         "bufferView 0: count * byteStride of the compressed data is not byteLength"},
        {"\"mode\": \"ATTRIBUTES\"", "\"mode\": \"ATTRIBUTES\", \"filter\": \"QUATERNION\"",
         "bufferView 0: filter \"QUATERNION\" does not fit mode ATTRIBUTES and byteStride 12"},
        {"{\"buffer\": 0, ", "{\"buffer\": 1, ",
         "bufferView 0: compressed bytes lie in a fallback buffer"},
    };
    for (const Change& change : cases) {
        CAPTURE(change.to);
        std::string json = parts.json;
        const size_t at = json.find(change.from);
        REQUIRE(at != std::string::npos);
        json.replace(at, std::string_view(change.from).size(), change.to);
        const auto scene = load(glb(json, join(parts.vertices, parts.indices)));
        REQUIRE_FALSE(scene.has_value());
        CHECK(scene.error().code == Errc::malformed);
        CHECK(scene.error().message == change.message);
    }
}

TEST_CASE("WebP textures are decoded, and taken before the fallback") {
    const Bytes pixels{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 255, 10, 20, 30, 255};
    uint8_t* encoded = nullptr;
    const size_t size = WebPEncodeLosslessRGBA(pixels.data(), 2, 2, 8, &encoded);
    const Bytes webp(encoded, encoded + size);
    WebPFree(encoded);
    const std::string json = document(
        R"("extensionsRequired": ["EXT_texture_webp"],
           "images": [{"uri": "data:image/png;base64,AAAA"}, {"uri": "data:image/webp;base64,)" +
        base64(webp) +
        R"("}], "textures": [{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}],
           "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    const auto scene = load_json(json);
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    CHECK(scene->textures[0].image == 1);
    CHECK(scene->images[1].rgba == pixels);
    CHECK(scene->images[0].width == 0);  // nothing uses it
}
