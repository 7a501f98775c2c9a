// SPDX-License-Identifier: Apache-2.0
// What the input held must be in the output, bit for bit.
#include "aglow/encode/gltf/testing/attributes.h"
#include "aglow/encode/testing/round_trip.h"
#include "aglow/scene/gltf_source.h"
#include "aglow/scene/image_file.h"

using namespace aglow;
using namespace aglow::encode::testing;
using aglow::gltf::edit::Json;
namespace fs = std::filesystem;

namespace {

/// A glTF file in the making.
struct Builder {
    Json json = {{"asset", {{"version", "2.0"}, {"generator", "hand"}}}};
    std::vector<uint8_t> bytes = {};

    template <class T>
    size_t view(const std::vector<T>& values, int stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        Json v = {
            {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride != 0) v["byteStride"] = stride;
        const auto* data = reinterpret_cast<const uint8_t*>(values.data());
        bytes.insert(bytes.end(), data, data + values.size() * sizeof(T));
        json["bufferViews"].push_back(v);
        return json["bufferViews"].size() - 1;
    }
    size_t accessor(Json a) {
        json["accessors"].push_back(std::move(a));
        return json["accessors"].size() - 1;
    }
    void save(const fs::path& path) {
        const std::string bin = path.stem().string() + ".bin";
        json["buffers"] = Json::array({{{"byteLength", bytes.size()}, {"uri", bin}}});
        REQUIRE(write_file(path.parent_path() / bin, bytes));
        REQUIRE(write_file(path, json.dump()));
    }
};

/// Two triangles that share an edge, with every kind of attribute there is.
Json everything(Builder& b) {
    const auto add = [&](size_t view, int component, const char* type, Json more = Json::object()) {
        Json a = {{"bufferView", view}, {"componentType", component}, {"count", 4}, {"type", type}};
        a.update(more);
        return b.accessor(std::move(a));
    };
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.25f};
    Json attributes = {
        {"POSITION", add(b.view(positions), 5126, "VEC3",
                         {{"min", {0, 0, 0}}, {"max", {1, 1, 0.25}}, {"name", "points"}})},
        {"NORMAL",
         add(b.view(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f}), 5126, "VEC3")},
        {"TANGENT", add(b.view(std::vector<float>{1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, 1}),
                        5126, "VEC4")},
        {"TEXCOORD_0", add(b.view(std::vector<uint16_t>{0, 0, 65535, 7, 9, 65535, 11, 13}), 5123,
                           "VEC2", {{"normalized", true}})},
        {"TEXCOORD_1", add(b.view(std::vector<float>{0, 0, 5, 0, 0, 5, 5, 5}), 5126, "VEC2")},
        {"COLOR_0",
         add(b.view(std::vector<uint8_t>{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0}, 4),
             5121, "VEC3", {{"normalized", true}})},
        {"_TEMPERATURE",
         add(b.view(std::vector<uint8_t>{21, 0, 0, 0, 22, 0, 0, 0, 23, 0, 0, 0, 24, 0, 0, 0}, 4),
             5121, "SCALAR", {{"extras", {{"unit", "C"}}}})}};
    const auto where = b.view(std::vector<uint16_t>{1, 3});
    const auto what = b.view(std::vector<float>{0, 0, 2, 0, 0, 3});
    const auto target = b.accessor({{"componentType", 5126},
                                    {"count", 4},
                                    {"type", "VEC3"},
                                    {"min", {0, 0, 0}},
                                    {"max", {0, 0, 3}},
                                    {"sparse",
                                     {{"count", 2},
                                      {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", what}}}}}});
    const auto indices = b.accessor({{"bufferView", b.view(std::vector<uint16_t>{0, 1, 2, 3})},
                                     {"componentType", 5123},
                                     {"count", 4},
                                     {"type", "SCALAR"}});
    return {{"attributes", attributes},
            {"indices", indices},
            {"mode", 5},
            {"material", 0},
            {"targets", Json::array({{{"POSITION", target}}})},
            {"extras", {{"keep", "primitive"}}}};
}

/// The file with everything; `change` edits the JSON before it is saved.
template <class Change>
fs::path save_everything(const fs::path& folder, const Change& change) {
    Builder b;
    const Json primitive = everything(b);
    b.json["meshes"] = Json::array({{{"name", "sheet"},
                                     {"primitives", Json::array({primitive})},
                                     {"weights", {0.5}},
                                     {"extras", {{"keep", "mesh"}}}}});
    b.json["materials"] = Json::array({{{"name", "paper"}, {"extras", {{"keep", "material"}}}}});
    b.json["nodes"] = Json::array(
        {{{"name", "flat"}, {"mesh", 0}, {"extras", {1, 2, 3}}}, {{"name", "eye"}, {"camera", 0}}});
    b.json["cameras"] = Json::array({{{"type", "perspective"},
                                      {"name", "lens"},
                                      {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}});
    b.json["scenes"] = Json::array({{{"nodes", {0, 1}}}, {{"name", "other"}, {"nodes", {1}}}});
    b.json["scene"] = 0;
    b.json["extensionsUsed"] = {"ACME_weather"};
    b.json["extensions"] = {{"ACME_weather", {{"rain", 0.3}, {"accessor", 2}}}};
    b.json["extras"] = {{"keep", "root"}};
    change(b.json);
    b.save(folder / "in.gltf");
    return folder / "in.gltf";
}

}  // namespace

TEST_CASE("attributes of every type, sparse morph targets and extras survive the split") {
    const TemporaryFolder folder;
    const fs::path in = save_everything(folder.path, [](Json&) {});
    const Scene before = load(in);
    for (const char* name : {"out.glb", "out.gltf"}) {
        CAPTURE(name);
        FakeBake bake(before);
        written(bake, folder.path / name);
        CHECK(validator_agrees({folder.path / name}));
        const Scene after = load(folder.path / name);
        check_attributes(before, after);
        const Json json = Json::parse(after.source->json);
        CHECK(json["extras"]["keep"] == "root");
        CHECK(json["meshes"][0]["extras"]["keep"] == "mesh");
        CHECK(json["meshes"][0]["primitives"][0]["extras"]["keep"] == "primitive");
        CHECK(json["materials"][0]["extras"]["keep"] == "material");
        CHECK(json["nodes"][0]["extras"] == Json({1, 2, 3}));
        CHECK(json["cameras"][0]["name"] == "lens");
        CHECK(json["scenes"][1]["name"] == "other");
        CHECK(json["asset"]["generator"] == "hand");
        CHECK(json["extensions"]["ACME_weather"]["rain"] == 0.3);
        CHECK(std::ranges::find(json["extensionsUsed"], "ACME_weather") !=
              json["extensionsUsed"].end());
        // An extension that is not known may mean any accessor: none may change its place.
        CHECK(json["accessors"][2]["type"] == "VEC4");
    }
}

TEST_CASE("creases and corners in extras name the same places after the split") {
    const TemporaryFolder folder;
    const fs::path in = save_everything(folder.path, [](Json& json) {
        json["meshes"][0]["primitives"][0]["extras"] = {
            {"creases", {{3, 1, 2.5}, {2, 0}, "mine", {0, 77}}}, {"corners", {{2, 1}, {3}}}};
    });
    const Scene before = load(in);
    FakeBake bake(before);
    written(bake, folder.path / "out.glb");
    const Scene after = load(folder.path / "out.glb");
    const Primitive& old_p = before.meshes[0].primitives[0];
    const Primitive& new_p = after.meshes[0].primitives[0];
    REQUIRE(new_p.positions.size() == 6);
    REQUIRE(old_p.creases.size() == 2);
    REQUIRE(new_p.creases.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
        CHECK(new_p.positions[new_p.creases[i].a] == old_p.positions[old_p.creases[i].a]);
        CHECK(new_p.positions[new_p.creases[i].b] == old_p.positions[old_p.creases[i].b]);
        CHECK(new_p.creases[i].sharpness == old_p.creases[i].sharpness);
        CHECK(new_p.positions[new_p.corners[i].vertex] == old_p.positions[old_p.corners[i].vertex]);
        CHECK(new_p.corners[i].sharpness == old_p.corners[i].sharpness);
    }
    const Json json = Json::parse(after.source->json);
    const Json& creases = json["meshes"][0]["primitives"][0]["extras"]["creases"];
    CHECK(creases[2] == "mine");
    CHECK(creases.size() == 3);  // a vertex that there never was has no place after it
}

TEST_CASE("the light takes another UV set where a texture reads the second one") {
    const TemporaryFolder folder;
    const fs::path in = save_everything(folder.path, [](Json& json) {
        json["images"] = Json::array(
            {{{"uri",
               "data:image/png;base64,"
               "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMI"
               "QAAAABJRU5ErkJggg=="}}});
        json["textures"] = Json::array({{{"source", 0}}});
        json["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}};
    });
    const Scene before = load(in);
    FakeBake bake(before);
    written(bake, folder.path / "out.glb");
    CHECK(validator_agrees({folder.path / "out.glb"}));
    Scene after = load(folder.path / "out.glb");
    const Json json = Json::parse(after.source->json);
    CHECK(json["materials"][0]["extensions"]["MOZ_lightmap"]["texCoord"] == 2);
    CHECK(json["materials"][0]["occlusionTexture"]["texCoord"] == 1);
    const Primitive& p = after.meshes[0].primitives[0];
    CHECK(p.texcoords[1][p.triangles[0].y].x == 5.0f);
    const auto lit = read_lit_gltf(after, folder.path / "out.glb");
    REQUIRE(lit);
    const Surfaces surfaces = pose(after, -1, &lit->atlas);
    CHECK(light_error(surfaces, lit->irradiance, origin_of(surfaces)) < 1e-4);
}

TEST_CASE("replaced data leaves the file where nothing else can refer to it") {
    const TemporaryFolder folder;
    const fs::path in = save_everything(folder.path, [](Json& json) {
        json.erase("extensions");
        json.erase("extensionsUsed");
    });
    const Scene before = load(in);
    FakeBake bake(before);
    written(bake, folder.path / "out.glb");
    CHECK(validator_agrees({folder.path / "out.glb"}));
    const Scene after = load(folder.path / "out.glb");
    check_attributes(before, after);
    const Json old_json = Json::parse(before.source->json);
    const Json new_json = Json::parse(after.source->json);
    CHECK(new_json["accessors"].size() == old_json["accessors"].size());
    // Six corners instead of four vertices, 4-byte strides, the morph target dense, and the image.
    const size_t vertices = 6 * (12 + 12 + 16 + 4 + 8 + 4 + 4 + 12) + 12;
    const size_t png = fs::file_size(folder.path / "out.lightmap.png");
    CHECK(after.source->buffers[0].size() <= vertices + png + 64);
}

TEST_CASE("a material that unlit meshes use too is not lit for them") {
    const TemporaryFolder folder;
    const fs::path in = save_everything(folder.path, [](Json& json) {
        Json lines = json["meshes"][0]["primitives"][0];
        lines["mode"] = 1;
        json["meshes"][0]["primitives"].push_back(lines);
        json["meshes"][0]["primitives"][0].erase("targets");
        json["meshes"][0]["primitives"][1].erase("targets");
        json["meshes"][0].erase("weights");
    });
    FakeBake bake(load(in));
    written(bake, folder.path / "out.glb");
    CHECK(validator_agrees({folder.path / "out.glb"}));
    const Json json = Json::parse(load(folder.path / "out.glb").source->json);
    const auto material = [&](size_t p) {
        return json["materials"][json["meshes"][0]["primitives"][p]["material"].get<size_t>()];
    };
    CHECK(material(0)["extensions"].contains("MOZ_lightmap"));
    CHECK(material(0)["name"] == "paper");
    CHECK(!material(1).contains("extensions"));
    CHECK(json["meshes"][0]["primitives"][1]["mode"] == 1);
}

TEST_CASE("a .gltf in another folder finds its images") {
    const TemporaryFolder folder;
    fs::create_directories(folder.path / "in" / "maps");
    fs::create_directories(folder.path / "out" / "maps");
    const std::vector<uint8_t> red = {255, 0, 0}, blue = {0, 0, 255};
    REQUIRE(write_file(folder.path / "in" / "maps" / "a b.png", encode_png(red, 1, 1, 3)));
    REQUIRE(write_file(folder.path / "in" / "maps" / "c.png", encode_png(blue, 1, 1, 3)));
    REQUIRE(write_file(folder.path / "out" / "maps" / "c.png", std::string_view("other")));
    const fs::path in = save_everything(folder.path / "in", [](Json& json) {
        json["images"] = Json::array({{{"uri", "maps/a%20b.png"}}, {{"uri", "maps/c.png"}}});
        json["textures"] = Json::array({{{"source", 0}}, {{"source", 1}}});
        json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
        json["materials"][0]["emissiveTexture"] = {{"index", 1}};
    });
    FakeBake bake(load(in));
    const auto files = written(bake, folder.path / "out" / "lit.gltf");
    CHECK(validator_agrees({files.outputs.front()}));
    const Scene after = load(files.outputs.front());
    CHECK(after.images[0].rgba == std::vector<uint8_t>{255, 0, 0, 255});
    CHECK(after.images[1].rgba == std::vector<uint8_t>{0, 0, 255, 255});
    // What stood there under the same name is not damaged.
    CHECK(fs::file_size(folder.path / "out" / "maps" / "c.png") == 5);
}
