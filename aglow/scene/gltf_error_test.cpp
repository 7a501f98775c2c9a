// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/test_files.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

/// A wrong file, and the sentence that says what is wrong with it.
struct Wrong {
    const char* members;
    const char* message;
};

void check_message(const Result<Scene>& scene, Errc code, std::string_view message) {
    REQUIRE_FALSE(scene.has_value());
    CHECK(scene.error().code == code);
    CHECK(scene.error().message == message);
    CHECK(scene.error().context == "test.glb");
}

/// Replaces the first `from` in the triangle's JSON.
Bytes changed_triangle(const std::string& from, const std::string& to) {
    std::string members = std::string(kTriangleBuffers) + ", " + kTriangleMesh;
    const size_t at = members.find(from);
    REQUIRE(at != std::string::npos);
    members.replace(at, from.size(), to);
    return glb(document(members), triangle_bytes());
}

}  // namespace

TEST_CASE("what a node names must exist, and the message names node and thing") {
    const Wrong cases[] = {
        {R"("nodes": [{}, {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 2}}}])",
         "node 1 \"lamp\": light 2 does not exist"},
        {R"("nodes": [{"mesh": 0}])", "node 0: mesh 0 does not exist"},
        {R"("nodes": [{"name": "ear", "skin": 2}])", "node 0 \"ear\": skin 2 does not exist"},
        {R"("nodes": [{"camera": 7}])", "node 0: camera 7 does not exist"},
        {R"("nodes": [{"children": [0, 9]}])", "node 0: child node 9 does not exist"},
        {R"("nodes": [{"mesh": -1}])", "node 0: mesh must be an index"},
        {R"("nodes": [{"mesh": 0.5}])", "node 0: mesh must be an index"},
        {R"("nodes": [{"mesh": 4294967296}])", "node 0: mesh 4294967296 does not exist"},
        {R"("nodes": [{"mesh": "0"}])", "node 0: mesh must be an index"},
        {R"("nodes": [7])", "node 0: must be an object"},
        {R"("nodes": {})", "nodes must be an array"},
        {R"("nodes": [{"name": 3}])", "node 0: name must be a string"},
        {R"("nodes": [{}], "scenes": [{"nodes": [1]}])", "scene 0: node 1 does not exist"},
        {R"("nodes": [{}], "scenes": [{"nodes": [0]}], "scene": 1)", "scene 1 does not exist"},
        {R"("nodes": [{"extensions": {"MSFT_lod": {"ids": [4]}}}])",
         "node 0: node 4 does not exist"},
        {R"("nodes": [{"weights": [1]}])", "node 0: has 1 weights for 0 morph targets"},
    };
    for (const Wrong& wrong : cases) {
        CAPTURE(wrong.members);
        check_message(load_json(document(wrong.members)), Errc::malformed, wrong.message);
    }
}

TEST_CASE("nodes must form trees") {
    const Wrong cases[] = {
        {R"("nodes": [{"children": [0]}])", "node 0: lies on or below a cycle of nodes"},
        {R"("nodes": [{}, {"children": [2]}, {"children": [3]}, {"children": [1]}])",
         "node 1: lies on or below a cycle of nodes"},
        {R"("nodes": [{"children": [2]}, {"children": [2]}, {"name": "twice"}])",
         "node 2 \"twice\": is a child of node 0 and of node 1"},
        {R"("nodes": [{"children": [1, 1]}, {}])", "node 1: is a child of node 0 and of node 0"},
    };
    for (const Wrong& wrong : cases) {
        CAPTURE(wrong.members);
        check_message(load_json(document(wrong.members)), Errc::malformed, wrong.message);
    }
}

TEST_CASE("numbers must be finite, of the right count and in range") {
    const Wrong cases[] = {
        {R"("nodes": [{"translation": [1, 2]}])", "node 0: translation must hold 3 numbers, not 2"},
        {R"("nodes": [{"translation": [1, 2, 1e39]}])",
         "node 0: translation must hold finite numbers"},
        {R"("nodes": [{"scale": [1, 2, null]}])", "node 0: scale must hold finite numbers"},
        {R"("nodes": [{"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0.5, 0,0,0,1]}])",
         "node 0: matrix is not an affine map: its last row must be 0 0 0 1"},
        {R"("materials": [{"name": "m", "emissiveFactor": [1, -1, 1]}])",
         "material 0 \"m\": emissiveFactor is negative"},
        {R"("materials": [{"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": -1}}}])",
         "material 0: emissiveStrength is negative"},
        {R"("materials": [{"alphaMode": "FOG"}])", "material 0: alphaMode \"FOG\" does not exist"},
        {R"("materials": [{"doubleSided": 1}])", "material 0: doubleSided must be true or false"},
        {R"("materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])",
         "material 0: texture 0 does not exist"},
        {R"("materials": [{"emissiveTexture": {}}])", "material 0: index is missing"},
        {R"("cameras": [{"type": "perspective", "perspective": {"yfov": 0, "znear": 1}}])",
         "camera 0: yfov must be in 0..pi"},
        {R"("cameras": [{"type": "perspective"}])", "camera 0: perspective is missing"},
        {R"("cameras": [{"type": "fisheye"}])", "camera 0: type \"fisheye\" does not exist"},
        {R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": -5}]}})",
         "light 0: intensity is negative"},
        {R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "area"}]}})",
         "light 0: type \"area\" does not exist"},
        {R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"innerConeAngle": 1, "outerConeAngle": 0.5}}]}})",
         "light 0: cone angles must be 0 <= inner < outer <= pi/2"},
        {R"("textures": [{"source": 3}])", "texture 0: image 3 does not exist"},
        {R"("textures": [{"sampler": 0}])", "texture 0: sampler 0 does not exist"},
        {R"("samplers": [{"wrapS": 5}])", "sampler 0: wrapS 5 does not exist"},
        {R"("images": [{"bufferView": 0}])", "image 0: bufferView 0 does not exist"},
    };
    for (const Wrong& wrong : cases) {
        CAPTURE(wrong.members);
        check_message(load_json(document(wrong.members)), Errc::malformed, wrong.message);
    }
}

TEST_CASE("buffers, views and accessors may not reach beyond their bytes") {
    struct Change {
        const char *from, *to, *message;
    };
    const Change cases[] = {
        {"\"byteLength\": 44", "\"byteLength\": 45",
         "buffer 0: byteLength is 45, but there are 44 bytes"},
        {"\"byteLength\": 44", "\"byteLength\": -1",
         "buffer 0: byteLength must be a non-negative integer"},
        {"\"byteOffset\": 36", "\"byteOffset\": 37",
         "bufferView 1: 8 bytes from 37 on exceed buffer 0, which has 44"},
        {"\"byteOffset\": 36", "\"byteOffset\": 18446744073709551612",
         "bufferView 1: 8 bytes from 18446744073709551612 on exceed buffer 0, which has 44"},
        {"\"byteLength\": 36", "\"byteLength\": 18446744073709551615",
         "bufferView 0: 18446744073709551615 bytes from 0 on exceed buffer 0, which has 44"},
        {"\"buffer\": 0, \"byteLength\": 36", "\"buffer\": 1, \"byteLength\": 36",
         "bufferView 0: buffer 1 does not exist"},
        {"\"byteLength\": 36", "\"byteLength\": 36, \"byteStride\": 8",
         "accessor 0: byteStride 8 of bufferView 0 is less than an element's 12"},
        {"\"byteLength\": 36", "\"byteLength\": 36, \"byteStride\": 16",
         "accessor 0: 3 elements exceed bufferView 0"},
        {"\"count\": 3", "\"count\": 4", "accessor 0: 4 elements exceed bufferView 0"},
        {"\"count\": 3", "\"count\": 4294967295", "accessor 0: count 4294967295 is too large"},
        {"\"count\": 3", "\"count\": -3", "accessor 0: count must be a non-negative integer"},
        {"\"count\": 3", "\"count\": 3, \"byteOffset\": 4",
         "accessor 0: 3 elements exceed bufferView 0"},
        {"\"count\": 3", "\"count\": 3, \"byteOffset\": 18446744073709551615",
         "accessor 0: 3 elements exceed bufferView 0"},
        {"5126", "5124", "accessor 0: componentType 5124 does not exist"},
        {"VEC3", "VEC5", "accessor 0: type \"VEC5\" does not exist"},
        {"\"indices\": 1", "\"indices\": 2", "mesh 0 \"m\" primitive 0: accessor 2 does not exist"},
        {"\"indices\": 1", "\"indices\": 0",
         "mesh 0 \"m\" primitive 0: indices must be of type SCALAR"},
        {"5123", "5122", "accessor 1: must hold unsigned integers"},
        {"\"indices\": 1", "\"indices\": 1, \"mode\": 7",
         "mesh 0 \"m\" primitive 0: mode 7 does not exist"},
        {"\"indices\": 1", "\"indices\": 1, \"material\": 0",
         "mesh 0 \"m\" primitive 0: material 0 does not exist"},
        {"\"POSITION\": 0", "\"POSITION\": 1",
         "mesh 0 \"m\" primitive 0: POSITION (accessor 1) must be of type VEC3"},
        {"\"POSITION\": 0", "\"POSITION\": 0, \"COLOR_0\": 1",
         "mesh 0 \"m\" primitive 0: COLOR_0 (accessor 1) must be of type VEC3"},
        {"\"indices\": 1", "\"targets\": [{\"POSITION\": 5}]",
         "mesh 0 \"m\" primitive 0 target 0: accessor 5 does not exist"},
        {"\"count\": 3", "\"count\": 3, \"sparse\": {\"count\": 4}",
         "accessor 0: sparse count exceeds count"},
        {"\"count\": 3", "\"count\": 3, \"sparse\": {\"count\": 1}",
         "accessor 0: sparse.indices is missing"},
        {"\"name\": \"m\"", "\"weights\": [1]", "mesh 0: has 1 weights for 0 morph targets"},
    };
    for (const Change& change : cases) {
        CAPTURE(change.to);
        check_message(load(changed_triangle(change.from, change.to)), Errc::malformed,
                      change.message);
    }
}

TEST_CASE("bytes of buffers are as untrusted as the JSON") {
    const std::string members = std::string(kTriangleBuffers) + ", " + kTriangleMesh;
    Bytes bad_index = triangle_bytes();
    bad_index[38] = 3;
    check_message(load(glb(document(members), bad_index)), Errc::malformed,
                  "mesh 0 \"m\" primitive 0: index 1 is 3, but there are 3 vertices");
    Bytes not_a_number = triangle_bytes();
    not_a_number[18] = 0xc0;  // the third component of the second vertex becomes NaN
    not_a_number[19] = 0x7f;
    check_message(load(glb(document(members), not_a_number)), Errc::malformed,
                  "accessor 0: element 1 is not finite");
}

TEST_CASE("a required extension that is not known is unsupported, by name") {
    for (const char* name : {"EXT_lights_image_based", "ACME_magic"}) {
        const std::string json = document(R"("extensionsUsed": [")" + std::string(name) +
                                          R"("], "extensionsRequired": [")" + name + "\"]");
        check_message(load_json(json), Errc::unsupported,
                      "required extension \"" + std::string(name) + "\" is not supported");
    }
    const char* known = R"("extensionsRequired": ["KHR_materials_clearcoat", "MX_lightmap",
        "MOZ_lightmap", "AGLOW_hierarchical_color", "KHR_mesh_quantization", "KHR_texture_basisu"])";
    CHECK(load_json(document(known)).has_value());
    CHECK(load_json(document(R"("extensionsUsed": ["ACME_magic"])")).has_value());
    const auto optional = load_json(document(R"("extensionsUsed": ["EXT_lights_image_based"])"));
    REQUIRE(optional.has_value());
    CHECK(optional->warnings ==
          std::vector<std::string>{
              "EXT_lights_image_based is not supported; its part of the light is left out"});
}

TEST_CASE("other versions of glTF are unsupported") {
    check_message(load_json(R"({"asset": {"version": "1.0"}})"), Errc::unsupported,
                  "glTF version \"1.0\" is not supported, 2.0 is");
    check_message(load_json(R"({"asset": {"version": "2.1", "minVersion": "2.1"}})"),
                  Errc::unsupported, "glTF version \"2.1\" is not supported, 2.0 is");
    check_message(load_json("{}"), Errc::malformed, "asset is missing: this is not glTF 2.0");
    check_message(load_json("[]"), Errc::malformed, "JSON root must be an object");
}

TEST_CASE("coordinates whose areas leave the range of float are refused") {
    const Bytes far =
        triangle_file(R"(, "nodes": [{"name": "far", "mesh": 0, "scale": [1e10, 1, 1]}])");
    check_message(load(far), Errc::unsupported,
                  "node 0 \"far\": its mesh reaches 1e+10 m; coordinates beyond 1e+09 m are not "
                  "supported");
    const char* overflow = R"("nodes": [{"scale": [1e30, 1, 1], "children": [1]},
                                        {"scale": [1e30, 1, 1]}])";
    check_message(load_json(document(overflow)), Errc::malformed,
                  "node 1: its transform to the world is not finite");
}
