// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf_source.h"
#include "aglow/scene/photometry.h"

#include <doctest/doctest.h>
#include <cmath>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

Scene load_members(const std::string& members) {
    auto scene = load_json(document(members));
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    return std::move(*scene);
}

}  // namespace

TEST_CASE("only nodes below the active scene's roots are in the scene") {
    const std::string nodes = R"("nodes": [{"children": [1]}, {}, {}])";
    Scene scene = load_members(nodes);
    for (const Node& node : scene.nodes) CHECK(node.in_scene);
    scene = load_members(nodes + R"(, "scenes": [{"nodes": [0]}, {"nodes": [2]}])");
    CHECK(scene.nodes[0].in_scene);
    CHECK(scene.nodes[1].in_scene);
    CHECK_FALSE(scene.nodes[2].in_scene);
    scene = load_members(nodes + R"(, "scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [2]}])");
    CHECK_FALSE(scene.nodes[1].in_scene);
    CHECK(scene.nodes[2].in_scene);
    CHECK(scene.nodes[1].parent == 0);
}

TEST_CASE("of several levels of detail only the finest is shown") {
    const Scene scene = load_members(R"("nodes": [{"extensions": {"MSFT_lod": {"ids": [1]}}},
        {"children": [2]}, {}, {}])");
    CHECK(scene.nodes[0].in_scene);
    CHECK_FALSE(scene.nodes[1].in_scene);
    CHECK_FALSE(scene.nodes[2].in_scene);
    CHECK(scene.nodes[3].in_scene);
}

TEST_CASE("lights have candela or lux per channel, and cones") {
    const Scene scene = load_members(R"("extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "spot", "name": "s", "color": [1, 0.5, 0.25], "intensity": 40, "range": 7,
         "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
        {"type": "directional"}, {"type": "point", "spot": {"outerConeAngle": 9}}]}},
        "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    CHECK(scene.lights[0].kind == LightKind::spot);
    CHECK(scene.lights[0].intensity == vec3{40, 20, 10});
    CHECK(scene.lights[0].inner_cone == 0.1f);
    CHECK(scene.lights[0].outer_cone == 0.2f);
    CHECK(scene.lights[0].range == 7);
    CHECK(scene.lights[1].kind == LightKind::directional);
    CHECK(scene.lights[1].intensity == vec3{1, 1, 1});
    CHECK(scene.lights[2].range == kInfinity);
    CHECK(scene.nodes[0].light == 0);
}

TEST_CASE("luminaires are lights of their nodes, tinted and multiplied there") {
    const std::string file = "TILT=NONE 1 -1 2 2 1 1 2 0 0 0 1 1 0 0 180 0 30 30";
    std::string ies = "IESNA:LM-63-2002\n" + file;
    ies.replace(ies.find("NONE ") + 4, 1, "\n");
    const std::string uri =
        "data:application/x-ies-lm-63;base64," + base64(Bytes(ies.begin(), ies.end()));
    const std::string profile = R"("extensions": {"EXT_lights_ies": {"lights": [
        {"uri": ")" + uri + R"(", "name": "lamp"}]},
        "KHR_lights_punctual": {"lights": [{"type": "point"}]}}, )";
    const Scene scene = load_members(profile + R"("nodes": [
        {"extensions": {"EXT_lights_ies": {"light": 0, "multiplier": 3, "color": [1, 0.5, 0]},
                        "KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"EXT_lights_ies": {"light": 0}}}])");
    REQUIRE(scene.lights.size() == 3);
    const Light& lamp = scene.lights[static_cast<size_t>(scene.nodes[0].light)];
    CHECK(lamp.kind == LightKind::photometric);
    CHECK(lamp.name == "lamp");
    CHECK(lamp.intensity == vec3{3, 1.5f, 0});
    CHECK(intensity(*lamp.photometry, {0, 1, 0}) == doctest::Approx(60));
    CHECK(scene.lights[static_cast<size_t>(scene.nodes[1].light)].intensity == vec3{1, 1, 1});

    const auto message = [&](const std::string& members) {
        const auto loaded = load_json(document(members));
        return loaded ? std::string("loads") : loaded.error().message;
    };
    CHECK(message(profile + R"("nodes": [{"extensions": {"EXT_lights_ies": {"light": 1}}}])") ==
          "node 0: light profile 1 does not exist");
    CHECK(message(R"("extensions": {"EXT_lights_ies": {"lights": [{"name": "x"}]}})") ==
          "light profile 0 \"x\": has to have either a uri or a bufferView");
    CHECK(message(R"("extensions": {"EXT_lights_ies": {"lights": [{"uri": "data:,IES"}]}})") ==
          "light profile 0: has no line TILT=");
}

TEST_CASE("materials hold luminance, clamped factors and texture transforms") {
    const std::string pixel =  // one white PNG pixel
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAC0lEQVR4nGP4DwQACfsD/fteaysAAAAASUVORK5CYI"
        "I=";
    const Scene scene =
        load_members(R"("images": [{"uri": "data:image/png;base64,)" + pixel +
                     R"("}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],
        "textures": [{"source": 0, "sampler": 0}], "materials": [
        {"emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0, "texCoord": 1},
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200}}},
        {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_unlit": {}}},
        {"pbrMetallicRoughness": {"baseColorFactor": [2, 0.5, -1, 0.25], "metallicFactor": 0,
          "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
            {"offset": [0.5, 0.25], "scale": [2, 3], "rotation": 1.5, "texCoord": 2}}}},
         "alphaMode": "MASK", "alphaCutoff": 0.75, "doubleSided": true},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 1]}}},
        {"pbrMetallicRoughness": {"metallicFactor": 0}}, {}])");
    CHECK(scene.materials[0].emission == vec3{200, 100, 0});
    CHECK(scene.materials[0].emissive_texture.texcoord == 1);
    CHECK(scene.materials[1].unlit);
    CHECK(scene.materials[1].emission == vec3{0, 0, 0});
    const Material& m = scene.materials[2];
    CHECK(m.base_color == vec4{1, 0.5f, 0, 0.25f});
    CHECK(m.base_color_texture.texcoord == 2);
    CHECK(m.base_color_texture.offset == vec2{0.5f, 0.25f});
    CHECK(m.base_color_texture.scale == vec2{2, 3});
    CHECK(m.base_color_texture.rotation == 1.5f);
    CHECK(m.alpha_mode == AlphaMode::mask);
    CHECK(m.alpha_cutoff == 0.75f);
    CHECK(m.double_sided);
    CHECK(scene.materials[3].base_color == vec4{0.1f, 0.2f, 0.3f, 1});
    CHECK(scene.materials[3].metallic == 0);
    CHECK(scene.textures[0].wrap_s == Wrap::clamp_to_edge);
    CHECK(scene.textures[0].wrap_t == Wrap::mirrored_repeat);
    CHECK(scene.textures[0].filter == Filter::nearest);
    CHECK(scene.images[0].rgba == std::vector<uint8_t>{255, 255, 255, 255});
    // The default metallic factor of 1 reflects nothing diffusely: material 5 needs no warning.
    const std::vector<std::string> expected{
        "material 2: baseColorFactor is clamped to 0..1",
        "material 2: reflectance 1 is clamped to 0.98 so that light dies out",
        "material 4: reflectance 1 is clamped to 0.98 so that light dies out"};
    CHECK(scene.warnings == expected);
}

TEST_CASE("a texture that no known format holds is unsupported, one without any image is white") {
    const std::string material =
        R"(, "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])";
    const auto foreign = load_json(document(
        R"("images": [{"uri": "data:image/ktx2;base64,AAAA"}],
           "textures": [{"extensions": {"KHR_texture_basisu": {"source": 0}}}])" +
        material));
    REQUIRE_FALSE(foreign.has_value());
    CHECK(foreign.error().code == Errc::unsupported);
    CHECK(foreign.error().message ==
          "texture 0: its only image is in a format that is not supported");
    const auto none = load_json(document(R"("textures": [{}])" + material));
    REQUIRE(none.has_value());
    CHECK(none->materials[0].base_color_texture.texture == -1);
}

TEST_CASE("instances stand at T * R * S of their node") {
    Bytes bytes = triangle_bytes();
    append(bytes, bytes_of<float>({1, 2, 3, 4, 5, 6}));
    append(bytes, bytes_of<int8_t>({0, 0, 0, 127, 0, 127, 0, 0}));  // none; half a turn about y
    append(bytes, bytes_of<float>({1, 1, 1, 2, -1, 1}));
    std::string members = R"("buffers": [{"byteLength": 100}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 44, "byteLength": 24},
        {"buffer": 0, "byteOffset": 68, "byteLength": 8}, {"buffer": 0, "byteOffset": 76, "byteLength": 24}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
        {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 2},
        {"bufferView": 2, "componentType": 5120, "normalized": true, "type": "VEC4", "count": 2},
        {"bufferView": 3, "componentType": 5126, "type": "VEC3", "count": 2}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes":
        {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3}}}}])";
    const auto scene = load(glb(document(members), bytes));
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    const auto& instances = scene->nodes[0].instances;
    REQUIRE(instances.size() == 2);
    CHECK(transform_point(instances[0], {1, 1, 1}) == vec3{2, 3, 4});
    // Scaled to (2, -1, 1), turned to (-2, -1, -1), moved.
    CHECK(length(transform_point(instances[1], {1, 1, 1}) - vec3{2, 4, 5}) < 1e-6f);
}

TEST_CASE("animation keys are kept, and those that cannot be are malformed") {
    Bytes bytes = bytes_of<float>({0, 1, 5, 5, 5, 6, 6, 6});
    const auto with = [&](const std::string& count, const std::string& path) {
        return load(glb(document(R"("buffers": [{"byteLength": 32}],
          "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 2},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": )" +
                                 count + R"(}],
          "nodes": [{"name": "n"}], "animations": [{"samplers": [{"input": 0, "output": 1}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": ")" +
                                 path + R"("}},
                         {"sampler": 0, "target": {"path": "pointer"}}]}])"),
                        bytes));
    };
    const auto scene = with("2", "translation");
    REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : scene.error().message));
    REQUIRE(scene->animations[0].channels.size() == 1);
    CHECK(scene->animations[0].channels[0].times == std::vector<float>{0, 1});
    CHECK(transform_point(world_transforms(*scene, 0.25)[0], {0, 0, 0}) ==
          vec3{5.25f, 5.25f, 5.25f});
    CHECK(with("1", "translation").error().message ==
          "animation 0 channel 0: has 3 numbers for 2 keys of 3");
    CHECK(with("2", "rotation").error().message ==
          "animation 0 channel 0: output must have 4 components");
    CHECK(with("2", "weights").error().message ==
          "animation 0 channel 0: moves morph targets of a node that has none");
    CHECK(with("2", "color").error().message ==
          "animation 0 channel 0: path \"color\" does not exist");
}

TEST_CASE("the source keeps text, buffers and encoded images as they were") {
    const std::string json = document(
        R"("buffers": [{"byteLength": 2, "uri": "data:;base64,AQID"}],
           "images": [{"uri": "data:image/png;base64,BAUG"}], "extras": {"mine": [1]})");
    const auto scene = load_json(json, "some/folder");
    REQUIRE(scene.has_value());
    CHECK(scene->name == "test.glb");
    CHECK(scene->source->json == json);
    CHECK(scene->source->buffers == std::vector<Bytes>{{1, 2}});
    CHECK(scene->source->images == std::vector<Bytes>{{4, 5, 6}});
    CHECK(scene->source->folder == "some/folder");
}
