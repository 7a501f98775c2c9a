// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/rewrite_gltf.h"

#include "aglow/scene/gltf/edit/document.h"
#include "aglow/scene/gltf/test_files.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

using namespace aglow;
using namespace aglow::gltf_test;
using aglow::testing::TemporaryFolder;
using gltf::edit::Json;

namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kFloat = 5126;

/// A file of accessors, each with a bufferView of its own.
struct File {
    Bytes bytes;
    Json views = Json::array(), accessors = Json::array();

    /// `stride` bytes from one element to the next.
    template <class T>
    int add(const std::vector<T>& values, int component, const char* type, size_t stride) {
        const Bytes data = bytes_of(values);
        views.push_back({{"buffer", 0},
                         {"byteOffset", bytes.size()},
                         {"byteLength", data.size()},
                         {"byteStride", stride}});
        append(bytes, data);
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", component},
                             {"normalized", component != kFloat},
                             {"count", data.size() / stride},
                             {"type", type}});
        return static_cast<int>(accessors.size()) - 1;
    }
    Scene load(const Json& primitives) const {
        const Json json = {{"asset", {{"version", "2.0"}}},
                           {"extensionsUsed", {"KHR_mesh_quantization"}},
                           {"extensionsRequired", {"KHR_mesh_quantization"}},
                           {"buffers", Json::array({{{"byteLength", bytes.size()}}})},
                           {"bufferViews", views},
                           {"accessors", accessors},
                           {"meshes", Json::array({{{"primitives", primitives}}})},
                           {"nodes", Json::parse(R"([{"mesh": 0, "skin": 0}, {}, {}])")},
                           {"skins", Json::parse(R"([{"joints": [1, 2]}])")}};
        Result<Scene> scene = gltf_test::load(glb(json.dump(), bytes));
        REQUIRE_MESSAGE(scene, (scene ? "" : to_string(scene.error())));
        return std::move(*scene);
    }
};

/// One triangle, all of whose attributes are as small as KHR_mesh_quantization lets them be.
Json quantized_attributes(File& file) {
    Json json;
    json["POSITION"] =
        file.add<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 16384, 0}, kShort, "VEC3", 8);
    json["NORMAL"] = file.add<int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 0, 0, 127, 0}, kByte, "VEC3", 4);
    json["TEXCOORD_0"] = file.add<uint16_t>({0, 0, 65535, 0, 0, 13107}, kUnsignedShort, "VEC2", 4);
    return json;
}

struct Rewritten {
    Scene scene;
    Json json;
};

Rewritten rewritten(const Scene& scene) {
    const TemporaryFolder folder;
    const auto path = folder.path / "out.glb";
    const auto files = rewrite_gltf(scene, path);
    REQUIRE_MESSAGE(files, (files ? "" : to_string(files.error())));
    CHECK(files->warnings.empty());
    auto back = load_scene(path);
    REQUIRE_MESSAGE(back, (back ? "" : to_string(back.error())));
    auto document = gltf::edit::open_document(*back);
    REQUIRE(document);
    return {std::move(*back), std::move(document->json)};
}

/// As refining does: the primitive's vertices again, each between itself and the first.
void shrink(Primitive& p) {
    for (vec3& x : p.positions) x = (x + p.positions[0]) * 0.5f;
    for (vec2& uv : p.texcoords[0]) uv = uv * 0.5f;
}

}  // namespace

TEST_CASE("quantized attributes come out as floats, and their extension goes with the last") {
    File file;
    const Json attributes = quantized_attributes(file);
    Scene scene = file.load(Json::array({{{"attributes", attributes}}}));
    Primitive& p = scene.meshes[0].primitives[0];
    CHECK(p.positions[1] == vec3{1, 0, 0});
    shrink(p);
    const auto [back, json] = rewritten(scene);
    const Primitive& q = back.meshes[0].primitives[0];
    CHECK(q.positions == p.positions);
    CHECK(q.normals == p.normals);
    CHECK(q.texcoords == p.texcoords);
    CHECK_FALSE(json.contains("extensionsUsed"));
    CHECK_FALSE(json.contains("extensionsRequired"));
    for (const auto& attribute :
         json.at("meshes")[0].at("primitives")[0].at("attributes").items()) {
        CAPTURE(attribute.key());
        const Json& of = json.at("accessors").at(attribute.value().get<size_t>());
        CHECK(of.at("componentType") == kFloat);
        CHECK_FALSE(of.value("normalized", false));
    }
}

TEST_CASE("quantized points beside the triangles stay as they are, with their extension") {
    File file;
    const Json attributes = quantized_attributes(file);
    const Json positions = {{"POSITION", attributes.at("POSITION")}};
    Scene scene = file.load(
        Json::array({{{"attributes", attributes}}, {{"attributes", positions}, {"mode", 0}}}));
    shrink(scene.meshes[0].primitives[0]);
    const Json json = rewritten(scene).json;
    CHECK(json.at("extensionsRequired") == Json::array({"KHR_mesh_quantization"}));
    const Json& points = json.at("meshes")[0].at("primitives")[1];
    const Json& of = json.at("accessors").at(points.at("attributes").at("POSITION").get<size_t>());
    CHECK(points.at("mode") == 0);
    CHECK(of.at("componentType") == kShort);
    CHECK(of.at("normalized") == true);
}

TEST_CASE("eight influences of a vertex are two sets of four, of joints as narrow as they can be") {
    for (const uint32_t last_joint : {1u, 255u, 256u}) {
        CAPTURE(last_joint);
        File file;
        Json attributes = quantized_attributes(file);
        for (const int set : {0, 1}) {
            attributes[fmt::format("JOINTS_{}", set)] =
                file.add<uint8_t>(Bytes(12, static_cast<uint8_t>(set)), kUnsignedByte, "VEC4", 4);
            file.accessors.back().erase("normalized");
            attributes[fmt::format("WEIGHTS_{}", set)] = file.add<uint8_t>(
                {64, 64, 0, 0, 64, 64, 0, 0, 64, 64, 0, 0}, kUnsignedByte, "VEC4", 4);
        }
        Scene scene = file.load(Json::array({{{"attributes", attributes}}}));
        // The skin has as many joints as the vertices name: the same few nodes again.
        auto source = std::make_shared<GltfSource>(*scene.source);
        Json json = Json::parse(source->json);
        json["skins"][0]["joints"] = std::vector<int>(last_joint + 1, 1);
        source->json = json.dump();
        scene.source = source;
        Primitive& p = scene.meshes[0].primitives[0];
        REQUIRE(p.influences == 8);
        p.joints[8 * 2 + 5] = last_joint;
        const auto [back, out] = rewritten(scene);
        const Primitive& q = back.meshes[0].primitives[0];
        CHECK(q.influences == 8);
        for (size_t i = 0; i < p.weights.size(); ++i) {
            CHECK(q.weights[i] == doctest::Approx(p.weights[i]).epsilon(1e-6));
            if (p.weights[i] > 0) CHECK(q.joints[i] == p.joints[i]);
        }
        const Json& written = out.at("meshes")[0].at("primitives")[0].at("attributes");
        for (const char* name : {"JOINTS_0", "JOINTS_1"})
            CHECK(out.at("accessors").at(written.at(name).get<size_t>()).at("componentType") ==
                  (last_joint > 255 ? kUnsignedShort : kUnsignedByte));
    }
}

TEST_CASE("a scene of other meshes than its file is not written") {
    File file;
    Scene scene = file.load(Json::array({{{"attributes", quantized_attributes(file)}}}));
    const TemporaryFolder folder;
    const auto refused = [&] {
        const auto files = rewrite_gltf(scene, folder.path / "out.glb");
        return !files && files.error().code == Errc::malformed &&
               std::filesystem::is_empty(folder.path);
    };
    Scene whole = scene;
    scene.meshes[0].primitives.emplace_back();
    CHECK(refused());
    scene.meshes.clear();
    CHECK(refused());
    whole.nodes.clear();  // what is not a mesh is the file's
    CHECK(rewrite_gltf(whole, folder.path / "out.glb").has_value());
}
