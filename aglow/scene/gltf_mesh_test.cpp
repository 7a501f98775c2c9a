// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf/triangles.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

/// A primitive over float attributes, all of one buffer: name, numbers, components.
struct Attribute {
    const char* name;
    std::vector<float> values;
    size_t components;
};

std::string accessor(size_t view, size_t count, size_t components) {
    const std::string type = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
    return fmt::format(R"({{"bufferView": {}, "componentType": 5126, "type": "{}", "count": {}}})",
                       view, type, count);
}

Result<Scene> load_primitive(const std::vector<Attribute>& attributes,
                             const std::string& more = "") {
    Bytes bytes;
    std::string views, accessors, names;
    for (size_t i = 0; i < attributes.size(); ++i) {
        const Attribute& a = attributes[i];
        const char* comma = i > 0 ? "," : "";
        views += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", comma,
                             bytes.size(), 4 * a.values.size());
        accessors += comma + accessor(i, a.values.size() / a.components, a.components);
        names += fmt::format(R"({}"{}": {})", comma, a.name, i);
        append(bytes, bytes_of(a.values));
    }
    return load(glb(document(fmt::format(R"("buffers": [{{"byteLength": {}}}], "bufferViews": [{}],
        "accessors": [{}], "meshes": [{{"primitives": [{{"attributes": {{{}}}{}}}]}}])",
                                         bytes.size(), views, accessors, names, more)),
                    bytes));
}

const std::vector<float> kRightTriangle = {0, 0, 0, 2, 0, 0, 0, 2, 0};

}  // namespace

TEST_CASE("strips and fans are the triangles that the specification lists") {
    const std::vector<uint32_t> indices{10, 11, 12, 13, 14};
    CHECK(gltf::triangles_of(5, indices) ==
          std::vector<uvec3>{{10, 11, 12}, {11, 13, 12}, {12, 13, 14}});
    CHECK(gltf::triangles_of(6, indices) ==
          std::vector<uvec3>{{11, 12, 10}, {12, 13, 10}, {13, 14, 10}});
    CHECK(gltf::triangles_of(4, indices) == std::vector<uvec3>{{10, 11, 12}});
    for (const int mode : {0, 1, 2, 3}) CHECK(gltf::triangles_of(mode, indices).empty());
    for (const int mode : {4, 5, 6}) CHECK(gltf::triangles_of(mode, {}).empty());
}

TEST_CASE("a primitive without normals is split into flat triangles that remember their vertices") {
    // Two triangles of a folded sheet share the edge from vertex 0 to vertex 1.
    const auto scene = load_primitive({{"POSITION", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3},
                                       {"TEXCOORD_0", {0, 1, 2, 3, 4, 5, 6, 7}, 2}},
                                      R"(, "mode": 5)");
    REQUIRE(scene.has_value());
    const Primitive& primitive = scene->meshes[0].primitives[0];
    CHECK(primitive.source_vertex == std::vector<uint32_t>{0, 1, 2, 1, 3, 2});
    REQUIRE(primitive.normals.size() == 6);
    CHECK(primitive.normals[0] == vec3{0, 0, 1});
    CHECK(primitive.normals[2] == vec3{0, 0, 1});
    CHECK(dot(primitive.normals[3], vec3{1, 1, 1}) == doctest::Approx(-1.7320508));
    CHECK(primitive.texcoords[0][4] == vec2{6, 7});
    CHECK(primitive.triangles[1] == uvec3{3, 4, 5});
}

TEST_CASE("given normals become unit length; those without direction face as their triangles do") {
    const auto scene = load_primitive(
        {{"POSITION", kRightTriangle, 3}, {"NORMAL", {0, 0, 3, 0, 0, 0, 0.6f, 0, 0.8f}, 3}});
    REQUIRE(scene.has_value());
    const Primitive& primitive = scene->meshes[0].primitives[0];
    CHECK(primitive.source_vertex.empty());
    CHECK(primitive.normals[0] == vec3{0, 0, 1});
    CHECK(primitive.normals[1] == vec3{0, 0, 1});
    CHECK(length(primitive.normals[2] - vec3{0.6f, 0, 0.8f}) < 1e-6f);
    REQUIRE(scene->warnings.size() == 1);
    CHECK(scene->warnings[0] == "mesh 0 primitive 0: 1 normals of length zero are replaced");
}

TEST_CASE("flat normals survive triangles of a micrometre and of a thousand kilometres") {
    for (const float size : {1e-6f, 1e6f}) {
        std::vector<float> positions = kRightTriangle;
        for (float& v : positions) v *= size;
        const auto scene = load_primitive({{"POSITION", positions, 3}});
        REQUIRE(scene.has_value());
        CHECK(scene->meshes[0].primitives[0].normals[0] == vec3{0, 0, 1});
    }
}

TEST_CASE("points, lines and primitives without POSITION have no triangles") {
    for (const int mode : {0, 1, 2, 3}) {
        const auto scene =
            load_primitive({{"POSITION", kRightTriangle, 3}}, fmt::format(R"(, "mode": {})", mode));
        REQUIRE(scene.has_value());
        CHECK(scene->meshes[0].primitives[0].triangles.empty());
    }
    const auto scene = load_primitive({{"NORMAL", kRightTriangle, 3}});
    REQUIRE(scene.has_value());
    CHECK(scene->meshes[0].primitives[0].triangles.empty());
    REQUIRE(scene->warnings.size() == 1);
    CHECK(scene->warnings[0] == "mesh 0 primitive 0: has no POSITION and is left out");
}

TEST_CASE("quantised attributes are scaled to their range") {
    // Positions as normalised shorts, normals as normalised bytes, UVs as normalised ushorts.
    Bytes bytes = bytes_of<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 16384, 0});
    append(bytes, bytes_of<int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}));
    append(bytes, bytes_of<uint16_t>({0, 0, 65535, 0, 0, 13107}));
    const auto scene = load(
        glb(document(
                R"("extensionsRequired": ["KHR_mesh_quantization"], "buffers": [{"byteLength": 48}],
           "bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 8},
                           {"buffer": 0, "byteOffset": 24, "byteLength": 12, "byteStride": 4},
                           {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
           "accessors": [{"bufferView": 0, "componentType": 5122, "normalized": true, "type": "VEC3", "count": 3},
                         {"bufferView": 1, "componentType": 5120, "normalized": true, "type": "VEC3", "count": 3},
                         {"bufferView": 2, "componentType": 5123, "normalized": true, "type": "VEC2", "count": 3}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}]}])"),
            bytes));
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    const Primitive& primitive = scene->meshes[0].primitives[0];
    CHECK(primitive.positions[1] == vec3{1, 0, 0});
    CHECK(primitive.positions[2].y == -1);
    CHECK(primitive.positions[2].z == doctest::Approx(16384.0 / 32767));
    CHECK(primitive.normals[0] == vec3{0, 0, 1});
    CHECK(primitive.texcoords[0][2].y == doctest::Approx(0.2));
}

TEST_CASE("vertex colours of three channels are opaque, and colours stay in 0..1 with a warning") {
    const auto scene = load_primitive({{"POSITION", kRightTriangle, 3},
                                       {"NORMAL", {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3},
                                       {"COLOR_0", {0.1f, 0.2f, 0.3f, 2, -1, 0, 1, 1, 1}, 3}});
    REQUIRE(scene.has_value());
    const Primitive& primitive = scene->meshes[0].primitives[0];
    CHECK(primitive.colors[0] == vec4{0.1f, 0.2f, 0.3f, 1});
    CHECK(primitive.colors[1] == vec4{1, 0, 0, 1});
    REQUIRE(scene->warnings.size() == 1);
    CHECK(scene->warnings[0] == "mesh 0 primitive 0: COLOR_0 is clamped to 0..1");
}

TEST_CASE("TEXCOORD_n stands at index n even where the file leaves numbers out") {
    const auto scene =
        load_primitive({{"POSITION", kRightTriangle, 3}, {"TEXCOORD_2", {1, 2, 3, 4, 5, 6}, 2}});
    REQUIRE(scene.has_value());
    const auto& sets = scene->meshes[0].primitives[0].texcoords;
    REQUIRE(sets.size() == 3);
    CHECK(sets[0] == std::vector<vec2>(3, vec2{0, 0}));
    CHECK(sets[2][1] == vec2{3, 4});
}

TEST_CASE("morph targets keep their displacements, also of split vertices") {
    const auto scene = load_primitive(
        {{"POSITION", kRightTriangle, 3}, {"TANGENT_FREE", {9, 9, 9, 8, 8, 8, 7, 7, 7}, 3}},
        R"(, "targets": [{"POSITION": 1}, {}])");
    REQUIRE(scene.has_value());
    const Mesh& mesh = scene->meshes[0];
    CHECK(mesh.weights == std::vector<float>{0, 0});
    REQUIRE(mesh.primitives[0].targets.size() == 2);
    CHECK(mesh.primitives[0].targets[0].positions[2] == vec3{7, 7, 7});
    CHECK(mesh.primitives[0].targets[1].positions.empty());
}

TEST_CASE("a skin without joints in the mesh is left out, a joint beyond the skin is malformed") {
    const std::string nodes = R"(, "nodes": [{"mesh": 0, "skin": 0}], "skins": [{"joints": [0]}])";
    const auto scene = load(triangle_file(nodes));
    REQUIRE(scene.has_value());
    CHECK(scene->nodes[0].skin == -1);
    CHECK(scene->warnings.size() == 1);

    Bytes bytes = triangle_bytes();
    append(bytes, Bytes{0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 5});
    append(bytes, bytes_of<float>({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}));
    const std::string members = R"("buffers": [{"byteLength": 104}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 44, "byteLength": 12},
                        {"buffer": 0, "byteOffset": 56, "byteLength": 48}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                      {"bufferView": 1, "componentType": 5121, "type": "VEC4", "count": 3},
                      {"bufferView": 2, "componentType": 5126, "type": "VEC4", "count": 3}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
        "nodes": [{"mesh": 0, "skin": 0}, {}], "skins": [{"joints": [0)";
    const auto one_joint = load(glb(document(members + "]}]"), bytes));
    REQUIRE_FALSE(one_joint.has_value());
    CHECK(one_joint.error().message == "node 0: mesh 0 uses joint 1 of skin 0, which has 1");
    // Joint 5 has no weight and need not exist.
    const auto two_joints = load(glb(document(members + ", 1]}]"), bytes));
    REQUIRE_MESSAGE(two_joints.has_value(), (two_joints ? "" : two_joints.error().message));
    const Primitive& primitive = two_joints->meshes[0].primitives[0];
    CHECK(primitive.influences == 4);
    CHECK(primitive.joints[5] == 1);
    CHECK(primitive.joints[11] == 0);
    CHECK(two_joints->skins[0].inverse_bind.size() == 2);
}

TEST_CASE("scalar tags are read, and follow their vertices into flat triangles") {
    const std::vector<Attribute> attributes = {
        {"POSITION", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3},
        {"_SHARPNESS", {0, 0.25f, 0.5f, 1}, 1},
        {"_TENSION", {4, 5, 6, 7}, 1},
        {"_BIAS", {-1, -2, -3, -4}, 1}};
    const auto scene = load_primitive(attributes, R"(, "mode": 5)");
    REQUIRE(scene.has_value());
    const Primitive& p = scene->meshes[0].primitives[0];
    CHECK(p.sharpness == std::vector<float>{0, 0.25f, 0.5f, 0.25f, 1, 0.5f});
    CHECK(p.tension == std::vector<float>{4, 5, 6, 5, 7, 6});
    CHECK(p.bias == std::vector<float>{-1, -2, -3, -2, -4, -3});
}

TEST_CASE("an attribute that only shares its name with a scalar tag is left out with a warning") {
    const auto scene =
        load_primitive({{"POSITION", kRightTriangle, 3}, {"_BIAS", {1, 2, 3, 4, 5, 6}, 2}});
    REQUIRE(scene.has_value());
    CHECK(scene->meshes[0].primitives[0].bias.empty());
    REQUIRE(scene->warnings.size() == 1);
    CHECK(scene->warnings[0] ==
          "mesh 0 primitive 0: _BIAS is left out: mesh 0 primitive 0: _BIAS (accessor 1) must be "
          "of type SCALAR");
}
