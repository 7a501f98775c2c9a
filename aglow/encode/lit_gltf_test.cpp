// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/lit_gltf.h"

#include "aglow/encode/gltf/light_coding.h"
#include "aglow/encode/testing/round_trip.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/gltf_source.h"
#include "aglow/scene/image_file.h"

#include <nlohmann/json.hpp>

using namespace aglow;
using namespace aglow::encode::testing;
namespace fs = std::filesystem;

namespace {

Scene cornell_box() {
    auto scene = builtin_scene("cornell-box");
    REQUIRE(scene);
    return std::move(*scene);
}

/// The box with its first mesh placed three times: moved, mirrored, and stretched.
Scene shared_meshes() {
    Scene scene = cornell_box();
    for (Node& node : scene.nodes)
        if (node.mesh >= 0) node.mesh = 0;
    Node extra;
    extra.mesh = 0;
    extra.name = "mirror";
    extra.translation = {2, 0.5f, -1};
    extra.scale = {-1, 1, 1};
    scene.nodes.push_back(extra);
    extra.name = "stretch";
    extra.translation = {-3, 0, 0};
    extra.rotation = {0, 0.6f, 0, 0.8f};
    extra.scale = {1, 2, 0.5f};
    scene.nodes.push_back(extra);
    return scene;
}

std::vector<uint8_t> bytes_of(const fs::path& path) {
    const auto bytes = read_file(path);
    REQUIRE(bytes);
    return *bytes;
}

nlohmann::json json_of(const fs::path& path) {
    return nlohmann::json::parse(load(path).source->json);
}

size_t files_in(const fs::path& folder) {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("light read back from a lit file belongs to the surface it was written for") {
    for (const char* name : {"lit.glb", "lit.gltf"}) {
        for (Scene scene : {cornell_box(), shared_meshes()}) {
            CAPTURE(name);
            const TemporaryFolder folder;
            FakeBake bake(std::move(scene));
            const LitFiles files = written(bake, folder.path / name);
            CHECK(files.outputs.front() == folder.path / name);
            CHECK(validator_agrees({files.outputs.front()}));

            Scene read = load(folder.path / name);
            const auto lit = read_lit_gltf(read, folder.path / name);
            REQUIRE_MESSAGE(lit, (lit ? "" : to_string(lit.error())));
            CHECK(read.warnings.empty());
            CHECK(lit->irradiance.pixels == bake.lightmap.irradiance.pixels);
            const Surfaces surfaces = pose(read, -1, &lit->atlas);
            CHECK(triangle_set(surfaces) == triangle_set(bake.surfaces));
            CHECK(light_error(surfaces, lit->irradiance, origin_of(surfaces)) < 1e-4);
        }
    }
}

TEST_CASE("meshes placed once need MOZ_lightmap alone") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    written(bake, folder.path / "lit.glb");
    const auto json = json_of(folder.path / "lit.glb");
    for (const auto& node : json["nodes"]) {
        if (!node.contains("mesh")) continue;
        const auto& light = node["extensions"]["MX_lightmap"];
        CHECK(light["scale"] == std::vector<int>{1, 1});
        CHECK(light["offset"] == std::vector<int>{0, 0});
    }
    for (const auto& mesh : json["meshes"]) {
        for (const auto& primitive : mesh["primitives"]) {
            const auto& material = json["materials"][primitive["material"].get<size_t>()];
            CHECK(material["extensions"]["MOZ_lightmap"]["texCoord"] == 1);
            CHECK(material["extensions"]["MOZ_lightmap"]["extras"]["units"] == "lux");
        }
    }
}

TEST_CASE("the PNG says what the EXR says, to the precision of eight bits") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    const LitFiles files = written(bake, folder.path / "lit.glb");
    fs::remove(folder.path / "lit.exr");
    Scene read = load(folder.path / "lit.glb");
    const auto lit = read_lit_gltf(read, folder.path / "lit.glb");
    REQUIRE(lit);
    REQUIRE(read.warnings.size() == 1);
    CHECK(read.warnings[0].find("lit.exr") != std::string::npos);
    const auto& exact = bake.lightmap.irradiance.pixels;
    for (size_t i = 0; i < exact.size(); ++i) {
        // Half a step of the sRGB curve, which is steepest at its top: 2.4 / 1.055 / 255 / 2.
        const double step = files.intensity * 0.00447;
        CHECK(std::abs(static_cast<double>(lit->irradiance.pixels[i].x - exact[i].x)) <= step);
        CHECK(std::abs(static_cast<double>(lit->irradiance.pixels[i].z - exact[i].z)) <= step);
    }
}

TEST_CASE("a damaged EXR is not trusted at any length") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    written(bake, folder.path / "lit.glb");
    const auto exr = bytes_of(folder.path / "lit.exr");
    const Scene original = load(folder.path / "lit.glb");
    for (size_t length = 0; length < exr.size(); length += 1 + exr.size() / 37) {
        CAPTURE(length);
        REQUIRE(write_file(folder.path / "lit.exr", std::span(exr).first(length)));
        Scene read = original;
        const auto lit = read_lit_gltf(read, folder.path / "lit.glb");
        REQUIRE(lit);
        CHECK(read.warnings.size() == 1);
        CHECK(lit->irradiance.width == bake.atlas.width);
    }
}

TEST_CASE("an EXR outside the folder is refused") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    written(bake, folder.path / "lit.gltf");
    auto json = json_of(folder.path / "lit.gltf");
    for (const char* name : {"../lit.exr", "/tmp/lit.exr", "a/../../lit.exr"}) {
        for (auto& material : json["materials"])
            if (material.contains("extensions") && material["extensions"].contains("MOZ_lightmap"))
                material["extensions"]["MOZ_lightmap"]["extras"]["exr"] = name;
        REQUIRE(write_file(folder.path / "lit.gltf", json.dump()));
        Scene read = load(folder.path / "lit.gltf");
        const auto lit = read_lit_gltf(read, folder.path / "lit.gltf");
        REQUIRE(!lit);
        CHECK(lit.error().code == Errc::malformed);
        CHECK(lit.error().message.find("leaves the folder") != std::string::npos);
    }
}

TEST_CASE("a broken lightmap extension is an error that names its element, never a crash") {
    const TemporaryFolder folder;
    FakeBake bake(shared_meshes());
    written(bake, folder.path / "lit.gltf");
    fs::remove(folder.path / "lit.exr");
    const auto good = json_of(folder.path / "lit.gltf");
    size_t node = 0;
    while (!good["nodes"][node].contains("mesh")) ++node;
    const auto primitive =
        good["meshes"][good["nodes"][node]["mesh"].get<size_t>()]["primitives"][0];
    const std::string moz = "/materials/" + std::to_string(primitive["material"].get<int>()) +
                            "/extensions/MOZ_lightmap";
    const std::string mx = "/nodes/" + std::to_string(node) + "/extensions/MX_lightmap";
    const std::vector<std::pair<std::string, nlohmann::json>> changes = {
        {moz + "/index", 99},
        {moz + "/index", "one"},
        {moz + "/texCoord", -1},
        {moz + "/index", -1},
        {moz + "/intensity", "bright"},
        {mx + "/scale", {1}},
        {mx + "/scale", "big"},
        {mx + "/offset", {"a", nullptr}},
        {mx + "/lightMapTexture", 3},
        {mx, {{"scale", {1, 1}}}},
        {mx + "/lightMapTexture/index", 4},
        {moz, 7}};
    for (const auto& [pointer, value] : changes) {
        CAPTURE(pointer);
        auto json = good;
        json[nlohmann::json::json_pointer(pointer)] = value;
        REQUIRE(write_file(folder.path / "lit.gltf", json.dump()));
        Scene read = load(folder.path / "lit.gltf");
        const auto lit = read_lit_gltf(read, folder.path / "lit.gltf");
        REQUIRE(!lit);
        CHECK((lit.error().code == Errc::malformed || lit.error().code == Errc::unsupported));
        CHECK(!lit.error().message.empty());
    }
}

TEST_CASE("baking a lit file again replaces its light and adds nothing") {
    const TemporaryFolder folder;
    FakeBake first(shared_meshes());
    written(first, folder.path / "lit.glb");
    FakeBake second(load(folder.path / "lit.glb"));
    written(second, folder.path / "again.glb");
    FakeBake third(load(folder.path / "again.glb"));
    written(third, folder.path / "thrice.glb");
    const auto a = json_of(folder.path / "again.glb"), b = json_of(folder.path / "thrice.glb");
    for (const char* key : {"images", "textures", "materials", "accessors", "bufferViews"})
        CHECK(a[key].size() == b[key].size());
    const auto bytes = [&](const char* name) {
        return static_cast<double>(fs::file_size(folder.path / name));
    };
    CHECK(bytes("again.glb") == doctest::Approx(bytes("thrice.glb")).epsilon(0.01));
    Scene read = load(folder.path / "thrice.glb");
    const auto lit = read_lit_gltf(read, folder.path / "thrice.glb");
    REQUIRE(lit);
    const Surfaces surfaces = pose(read, -1, &lit->atlas);
    CHECK(light_error(surfaces, lit->irradiance, origin_of(surfaces)) < 1e-4);
}

TEST_CASE("the same input gives the same bytes") {
    const TemporaryFolder one, two;
    FakeBake bake(shared_meshes());
    const auto names = written(bake, one.path / "lit.gltf").outputs;
    written(bake, two.path / "lit.gltf");
    for (const fs::path& name : names)
        CHECK(bytes_of(name) == bytes_of(two.path / name.filename()));
}

TEST_CASE("a failed write leaves nothing behind and damages nothing") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    SUBCASE("a folder stands where the manifest should go") {
        fs::create_directory(folder.path / "lit.manifest.json");
        REQUIRE(write_file(folder.path / "lit.glb", std::string_view("old")));
        const auto files = bake.write(folder.path / "lit.glb");
        REQUIRE(!files);
        CHECK(files.error().code == Errc::unreadable);
        CHECK(bytes_of(folder.path / "lit.glb").size() == 3);
        CHECK(files_in(folder.path) == 2);
    }
    SUBCASE("the folder does not exist") {
        const auto files = bake.write(folder.path / "nowhere" / "lit.glb");
        REQUIRE(!files);
        CHECK(files.error().code == Errc::unreadable);
        CHECK(files_in(folder.path) == 0);
    }
    SUBCASE("the ending is not glTF's") {
        const auto files = bake.write(folder.path / "lit.obj");
        REQUIRE(!files);
        CHECK(files.error().code == Errc::bad_argument);
        CHECK(files_in(folder.path) == 0);
    }
}

TEST_CASE("an output that would overwrite a file of the input is refused") {
    const TemporaryFolder folder;
    FakeBake first(cornell_box());
    written(first, folder.path / "room.gltf");
    FakeBake second(load(folder.path / "room.gltf"));
    fs::rename(folder.path / "room.gltf", folder.path / "house.gltf");
    second.scene.name = "house.gltf";
    const auto files = second.write(folder.path / "room.gltf");
    REQUIRE(!files);
    CHECK(files.error().code == Errc::bad_argument);
    CHECK(to_string(files.error()).find("room.bin") != std::string::npos);
}

TEST_CASE("a scene without light says so") {
    const TemporaryFolder folder;
    Scene scene = cornell_box();
    const auto lit = read_lit_gltf(scene, "cornell-box");
    REQUIRE(!lit);
    CHECK(lit.error().code == Errc::bad_argument);
}

TEST_CASE("the manifest states quantity, units and scale") {
    const TemporaryFolder folder;
    FakeBake bake(cornell_box());
    const LitFiles files = written(bake, folder.path / "lit.glb");
    const auto text = bytes_of(folder.path / "lit.manifest.json");
    const auto json = nlohmann::json::parse(text.begin(), text.end());
    CHECK(json["quantity"] == "irradiance");
    CHECK(json["units"] == "lux");
    CHECK(json["intensity"] == files.intensity);
    CHECK(json["atlas"] == std::vector<int>{bake.atlas.width, bake.atlas.height});
    for (const auto& [key, name] : json["files"].items())
        CHECK(fs::exists(folder.path / name.get<std::string>()));
}

TEST_CASE("intensity is the least two-digit number that holds 99.9 % of the texels") {
    CHECK(encode::round_up(0) == 1);
    CHECK(encode::round_up(1) == 1);
    CHECK(encode::round_up(1234) == 1300);
    CHECK(encode::round_up(1300) == 1300);
    CHECK(encode::round_up(0.0456) == 0.046);
    CHECK(encode::round_up(99.5) == 100);

    Lightmap map{Image(100, 100), std::vector<uint8_t>(10000, 1)};
    for (size_t i = 0; i < 10000; ++i) map.irradiance.pixels[i] = {1, 2, 50};
    for (size_t i = 0; i < 10; ++i) map.irradiance.pixels[i] = {1e6f, 0, 0};
    const auto coded = encode::code_light(map);
    REQUIRE(coded);
    CHECK(coded->intensity == 50);
    CHECK(coded->clipped_share == doctest::Approx(0.001));
}

TEST_CASE("the unlit form shows emission plus albedo / pi times irradiance") {
    const TemporaryFolder folder;
    FakeBake bake(shared_meshes());
    // One sample point in the middle of each triangle's cell is enough for a look.
    bake.texels.element_at.assign(bake.lightmap.covered.size(), kNoElement);
    for (uint32_t t = 0; t < bake.surfaces.triangles.size(); ++t) {
        const vec2 a = bake.surfaces.lightmap_uvs[bake.surfaces.triangles[t].x];
        const auto x = static_cast<uint32_t>(a.x + 1), y = static_cast<uint32_t>(a.y + 1);
        bake.texels.pixel_of.push_back(y * static_cast<uint32_t>(bake.atlas.width) + x);
        bake.texels.samples.push_back({t, {1.0f / 3, 1.0f / 3}});
        bake.texels.first_sample.push_back(t + 1);
    }
    LitOptions options;
    options.form = LitForm::unlit;
    options.exposure_ev = 3;
    const auto files = write_lit_gltf(bake.scene, bake.surfaces, bake.atlas, bake.texels,
                                      bake.lightmap, folder.path / "lit.glb", options);
    REQUIRE_MESSAGE(files, (files ? "" : to_string(files.error())));
    CHECK(validator_agrees({folder.path / "lit.glb"}));
    const Scene read = load(folder.path / "lit.glb");
    CHECK(triangle_set(pose(read)) == triangle_set(bake.surfaces));

    const auto picture = read_image(folder.path / "lit.unlit.png");
    REQUIRE(picture);
    for (size_t i = 0; i < bake.texels.element_count(); ++i) {
        const uint32_t pixel = bake.texels.pixel_of[i];
        const SurfacePoint at = bake.texels.samples[i];
        const vec3 luminance = emitted_luminance(bake.scene, bake.surfaces, at) +
                               base_color(bake.scene, bake.surfaces, at) *
                                   bake.lightmap.irradiance.pixels[pixel] / kPi;
        const vec3 shown = picture->pixels[pixel];
        CHECK(shown.x == doctest::Approx(std::min(1.0f, luminance.x * 8 / 100)).epsilon(0.01));
        CHECK(shown.y == doctest::Approx(std::min(1.0f, luminance.y * 8 / 100)).epsilon(0.01));
    }
    for (const auto& node : read.nodes) {
        if (node.mesh < 0) continue;
        for (const auto& primitive : read.meshes[static_cast<size_t>(node.mesh)].primitives)
            CHECK(read.materials[static_cast<size_t>(primitive.material)].unlit);
    }
}
