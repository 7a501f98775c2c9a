// SPDX-License-Identifier: Apache-2.0
// Damaged, deep and greedy files: an error or a scene, never a crash.
#include "aglow/core/file.h"
#include "aglow/core/testing/scenes.h"
#include "aglow/scene/gltf/container.h"
#include "aglow/scene/gltf/test_files.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace aglow;
using namespace aglow::gltf_test;
namespace fs = std::filesystem;

namespace {

Bytes read_scene_file(const char* name) {
    const auto bytes = read_file(scenes_folder() / name);
    return bytes ? *bytes : Bytes();
}

constexpr const char* kSmallFiles[] = {"khronos/Box/Box.glb", "khronos/BoxTextured/BoxTextured.glb",
                                       "khronos/RiggedSimple/RiggedSimple.glb",
                                       "khronos/SimpleInstancing/SimpleInstancing.glb"};

}  // namespace

TEST_CASE("a GLB file cut at any length is an error") {
    std::vector<Bytes> files{triangle_file()};
    for (const char* name : kSmallFiles) {
        Bytes bytes = read_scene_file(name);
        if (bytes.empty()) MESSAGE("skipped: " << name << " is absent");
        if (!bytes.empty()) files.push_back(std::move(bytes));
    }
    for (const Bytes& file : files) {
        REQUIRE(load(file).has_value());
        const size_t step = std::max<size_t>(1, file.size() / 2000);
        for (size_t length = 0; length < file.size(); length += step)
            CHECK_FALSE(load(std::span(file).first(length)).has_value());
    }
}

TEST_CASE("a JSON file cut at any length is an error") {
    const Bytes buffer = triangle_bytes();
    std::string members = std::string(kTriangleBuffers) + ", " + kTriangleMesh;
    const std::string length = "\"byteLength\": 44";
    members.replace(members.find(length), length.size(),
                    length + R"(, "uri": "data:;base64,)" + base64(buffer) + "\"");
    const std::string json = document(members);
    REQUIRE(load_json(json).has_value());
    for (size_t i = 0; i < json.size(); ++i) CHECK_FALSE(load_json(json.substr(0, i)).has_value());
}

TEST_CASE("a file with any one byte changed gives an error or a scene with valid indices") {
    std::vector<Bytes> files{triangle_file()};
    for (const char* name : kSmallFiles)
        if (Bytes bytes = read_scene_file(name); !bytes.empty()) files.push_back(std::move(bytes));
    for (const Bytes& file : files) {
        const size_t step = std::max<size_t>(1, file.size() / 1500);
        for (size_t at = 0; at < file.size(); at += step)
            for (const int change : {0x01, 0x10, 0x80, 0xff}) {
                Bytes damaged = file;
                damaged[at] = static_cast<uint8_t>(damaged[at] ^ change);
                const auto scene = load(damaged);
                if (!scene) {
                    CHECK_FALSE(scene.error().message.empty());
                    continue;
                }
                for (const Mesh& mesh : scene->meshes)
                    for (const Primitive& primitive : mesh.primitives)
                        for (const uvec3 t : primitive.triangles)
                            REQUIRE(std::max({t.x, t.y, t.z}) < primitive.positions.size());
            }
    }
}

TEST_CASE("a chain of 200 000 nodes loads, and its end is where the sum of the steps says") {
    constexpr int kCount = 200000;
    std::string nodes = R"("scenes": [{"nodes": [0]}], "nodes": [)";
    for (int i = 0; i + 1 < kCount; ++i)
        nodes += fmt::format(R"({{"translation": [0, 0.25, 0], "children": [{}]}},)", i + 1);
    nodes += R"({"translation": [0, 0.25, 0]}])";
    const auto scene = load_json(document(nodes));
    REQUIRE(scene.has_value());
    CHECK(scene->nodes.back().in_scene);
    CHECK(world_transforms(*scene).back().at(1, 3) == 50000);
}

TEST_CASE("a cycle of 200 000 nodes is found") {
    constexpr int kCount = 200000;
    std::string nodes = R"("nodes": [)";
    for (int i = 0; i < kCount; ++i)
        nodes += fmt::format(R"({}{{"children": [{}]}})", i > 0 ? "," : "", (i + 1) % kCount);
    const auto scene = load_json(document(nodes + "]"));
    REQUIRE_FALSE(scene.has_value());
    CHECK(scene.error().message == "node 0: lies on or below a cycle of nodes");
}

TEST_CASE("JSON nested a million levels deep is an error, not a stack overflow") {
    const std::string deep = document("\"extras\": " + std::string(1000000, '['));
    const auto scene = load_json(deep);
    REQUIRE_FALSE(scene.has_value());
    CHECK(scene.error().code == Errc::malformed);
    CHECK(scene.error().message == "JSON is nested deeper than 256");
    // Brackets inside of strings nest nothing.
    CHECK(load_json(document("\"extras\": \"\\\"" + std::string(1000, '[') + "\"")).has_value());
}

TEST_CASE("a few bytes cannot ask for gigabytes") {
    // Many primitives that share an accessor of zeros, gaps in the numbering of sets, instances.
    std::string primitives;
    for (int i = 0; i < 1000; ++i)
        primitives += std::string(i > 0 ? "," : "") + R"({"attributes": {"POSITION": 0}})";
    const std::string shared = document(
        R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 5000000}],
           "meshes": [{"primitives": [)" +
        primitives + "]}]");
    const auto many = load_json(shared);
    REQUIRE_FALSE(many.has_value());
    CHECK(many.error().code == Errc::out_of_memory);

    const std::string sets = document(
        R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 1000000},
                         {"componentType": 5126, "type": "VEC2", "count": 1000000}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_63": 1}}]}])");
    const auto gaps = load_json(sets);
    REQUIRE_FALSE(gaps.has_value());
    CHECK(gaps.error().code == Errc::out_of_memory);

    // Flat shading copies every morph target to the corners of every triangle.
    std::string targets;
    for (int i = 0; i < 2000; ++i) targets += std::string(i > 0 ? "," : "") + R"({"POSITION": 0})";
    const std::string mesh = R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0},
        "indices": 1, "targets": [)" +
                             targets + "]}]}]";
    Bytes bytes = bytes_of(std::vector<float>(9, 1));
    bytes.resize(36 + 2 * 300000);
    const auto copies = load(glb(
        document(
            R"("buffers": [{"byteLength": 600036}], "bufferViews": [{"buffer": 0, "byteLength": 36},
           {"buffer": 0, "byteOffset": 36, "byteLength": 600000}],
           "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
           {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 300000}], )" +
            mesh),
        bytes));
    REQUIRE_FALSE(copies.has_value());
    CHECK(copies.error().code == Errc::out_of_memory);

    const Bytes instances = triangle_file(
        R"(, "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
               {"attributes": {"TRANSLATION": 0}}}}])");
    CHECK(load(instances)->nodes[0].instances.size() == 3);
}

TEST_CASE("GLB headers that contradict the file are malformed") {
    const Bytes good = triangle_file();
    const auto with = [&](size_t at, uint8_t value) {
        Bytes file = good;
        file[at] = value;
        return load(file);
    };
    CHECK(with(4, 1).error().message == "GLB version 1 is not supported");
    CHECK(with(4, 1).error().code == Errc::unsupported);
    CHECK(with(11, 0xff).error().code == Errc::malformed);  // total length
    CHECK(with(15, 0xff).error().code == Errc::malformed);  // JSON chunk length
    CHECK(with(16, 'X').error().message == "first GLB chunk is not JSON");
    Bytes longer = good;
    longer.push_back(0);  // bytes after the stated length are not part of the file
    CHECK(load(longer).has_value());
}
