// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/obj/obj.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/core/file.h"
#include "aglow/scene/image_file.h"
#include "aglow/scene/load.h"
#include "aglow/scene/obj/polygon.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <rapidcheck.h>
#include <algorithm>
#include <cmath>
#include <string>

using namespace aglow;
namespace fs = std::filesystem;

namespace {

struct Folder : testing::TemporaryFolder {
    void put(const char* name, std::string_view text) const {
        REQUIRE(write_file(path / name, text));
    }
    Result<Scene> load(std::string_view obj) const {
        put("x.obj", obj);
        return load_obj(path / "x.obj");
    }
};

constexpr const char* kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

double area(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles) {
    double sum = 0;
    for (const uvec3 t : triangles)
        sum += static_cast<double>(
                   length(cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]))) /
               2;
    return sum;
}

}  // namespace

TEST_CASE("a square with everything becomes two triangles on four vertices") {
    const Folder folder;
    const auto scene = folder.load(std::string(kSquare) + "o tile\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
    REQUIRE(scene);
    CHECK(scene->name == "x.obj");
    REQUIRE(scene->meshes.size() == 1);
    CHECK(scene->meshes[0].name == "tile");
    REQUIRE(scene->nodes.size() == 1);
    CHECK(scene->nodes[0].mesh == 0);
    const Primitive& p = scene->meshes[0].primitives.at(0);
    CHECK(p.positions.size() == 4);
    CHECK(p.triangles.size() == 2);
    CHECK(area(p.positions, p.triangles) == doctest::Approx(1));
    for (const vec3 n : p.normals) CHECK(n == vec3{0, 0, 1});
    REQUIRE(p.texcoords.size() == 1);
    for (size_t i = 0; i < 4; ++i)  // OBJ counts v from below, glTF from above
        CHECK(p.texcoords[0][i] == vec2{p.positions[i].x, 1 - p.positions[i].y});
}

TEST_CASE("indices from the end and indices from the start name the same vertices") {
    const Folder folder;
    const auto a = folder.load(std::string(kSquare) + "f 1//1 2//1 3//1 4//1\n");
    const auto b = folder.load(std::string(kSquare) + "f -4//-1 -3//-1 -2//-1 -1//-1\n");
    REQUIRE(a);
    REQUIRE(b);
    CHECK(a->meshes[0].primitives[0].positions == b->meshes[0].primitives[0].positions);
    CHECK(a->meshes[0].primitives[0].triangles == b->meshes[0].primitives[0].triangles);
}

TEST_CASE("faces without normals are flat and share no vertices") {
    const Folder folder;
    const auto scene = folder.load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
    REQUIRE(scene);
    const Primitive& p = scene->meshes[0].primitives.at(0);
    CHECK(p.positions.size() == 6);
    for (size_t i = 0; i < 2; ++i) {
        const uvec3 t = p.triangles[i];
        for (const uint32_t v : {t.x, t.y, t.z})
            CHECK(p.normals[v] == (i == 0 ? vec3{0, 0, 1} : vec3{1, 0, 0}));
    }
}

TEST_CASE("materials set reflectance, luminance, opacity and group the faces") {
    const Folder folder;
    folder.put("m.mtl",
               "newmtl red\nKd 0.6 0.1 0.05\nnewmtl lamp\nKd 0.5 0.5 0.5\nKe 900 800 700\n"
               "newmtl glass\nKd 1 1 1\nd 0.25\nnewmtl tinted\nKd 1 1 1\nTr 0.4\n");
    const auto scene = folder.load(std::string("mtllib m.mtl\n") + kSquare +
                                   "usemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\nusemtl red\n"
                                   "f 2 3 4\nusemtl glass\nf 1 2 4\n");
    REQUIRE(scene);
    CHECK(scene->warnings.empty());
    REQUIRE(scene->materials.size() == 4);
    CHECK(scene->materials[0].name == "red");
    CHECK(scene->materials[0].base_color == vec4{0.6f, 0.1f, 0.05f, 1});
    CHECK(scene->materials[0].metallic == 0);
    CHECK(scene->materials[1].emission == vec3{900, 800, 700});
    CHECK(scene->materials[2].base_color.w == 0.25f);
    CHECK(scene->materials[2].alpha_mode == AlphaMode::blend);
    CHECK(scene->materials[3].base_color.w == doctest::Approx(0.6));
    CHECK(scene->materials[0].alpha_mode == AlphaMode::opaque);
    const auto& primitives = scene->meshes.at(0).primitives;
    REQUIRE(primitives.size() == 3);
    CHECK(primitives[0].material == 0);
    CHECK(primitives[0].triangles.size() == 2);
    CHECK(primitives[1].material == 1);
    CHECK(primitives[2].material == 2);
}

TEST_CASE("a texture is loaded once however many materials name it") {
    const Folder folder;
    Image image(2, 1);
    image.at(0, 0) = {1, 0, 0};
    image.at(1, 0) = {0, 1, 0};
    REQUIRE(write_image(image, folder.path / "p q.png"));
    folder.put("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd p q.png\nnewmtl b\nKd 1 1 1\nmap_Kd p q.png\n");
    const auto scene = folder.load(std::string("mtllib m.mtl\n") + kSquare + "f 1/1 2/2 3/3\n");
    REQUIRE(scene);
    REQUIRE(scene->images.size() == 1);
    CHECK(scene->images[0].rgba == std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255});
    CHECK(scene->materials.at(0).base_color_texture.texture == 0);
    CHECK(scene->materials.at(1).base_color_texture.texture == 0);
}

TEST_CASE("missing materials and textures are warnings that name them") {
    const Folder folder;
    folder.put("m.mtl", "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd gone.png\n");
    const auto scene = folder.load(std::string("mtllib lost.mtl\nmtllib m.mtl\n") + kSquare +
                                   "usemtl a\nf 1 2 3\nusemtl nobody\nf 1 3 4\n");
    REQUIRE(scene);
    const auto warned = [&](const char* word) {
        return std::any_of(scene->warnings.begin(), scene->warnings.end(),
                           [&](const std::string& w) { return w.find(word) != std::string::npos; });
    };
    CHECK(warned("lost.mtl"));
    CHECK(warned("gone.png"));
    CHECK(warned("\"nobody\" does not exist"));
    CHECK(scene->materials.at(0).base_color_texture.texture == -1);
}

TEST_CASE("materials are looked for in the OBJ's own folder and nowhere else") {
    const Folder folder;
    fs::create_directory(folder.path / "inner");
    folder.put("secret.mtl", "newmtl a\nKd 0.5 0.5 0.5\n");
    const std::string absolute = (folder.path / "secret.mtl").string();
    const std::vector<std::string> names = {"../secret.mtl", absolute, "..\\secret.mtl",
                                            "/dev/zero"};
    for (const std::string& name : names) {
        CAPTURE(name);
        REQUIRE(write_file(folder.path / "inner" / "x.obj",
                           std::string_view("mtllib " + name + "\n" + kSquare + "f 1 2 3\n")));
        const auto scene = load_obj(folder.path / "inner" / "x.obj");
        REQUIRE(scene);
        CHECK(scene->materials.empty());
        CHECK_FALSE(scene->warnings.empty());
    }
}

TEST_CASE("objects become meshes, and groups do where there are no objects") {
    const Folder folder;
    const auto objects = folder.load(
        std::string(kSquare) + "o first\ng part\nf 1 2 3\ng other\nf 1 3 4\no second\nf 2 3 4\n");
    REQUIRE(objects);
    REQUIRE(objects->meshes.size() == 2);
    CHECK(objects->meshes[0].name == "first");
    CHECK(objects->meshes[0].primitives[0].triangles.size() == 2);
    CHECK(objects->meshes[1].name == "second");
    const auto groups = folder.load(std::string(kSquare) + "g a\nf 1 2 3\ng b\nf 1 3 4\n");
    REQUIRE(groups);
    REQUIRE(groups->meshes.size() == 2);
}

TEST_CASE("broken files are refused and the element named") {
    const Folder folder;
    const auto message = [&](const std::string& faces) {
        const auto scene = folder.load(kSquare + faces);
        REQUIRE_FALSE(scene);
        CHECK(scene.error().code == Errc::malformed);
        return to_string(scene.error());
    };
    CHECK(message("f 1 2 3\nf 1 2 5\n") == "x.obj: face 2: vertex 5 does not exist");
    CHECK(message("f -5 -1 -2\n") == "x.obj: face 1: vertex -5 does not exist");
    CHECK(message("f 0 1 2\n") == "x.obj: face 1: vertices are counted from 1");
    CHECK(message("f 1//2 2//1 3//1\n") == "x.obj: face 1: normal 2 does not exist");
    CHECK(message("f 1/9 2/1 3/1\n") == "x.obj: face 1: texture coordinate 9 does not exist");
    CHECK(message("f 1 2 99999999999\n").starts_with("x.obj: face 1"));
    CHECK(message("v 1e999 0 0\nf 1 2 3\n") == "x.obj: vertex 5 is not finite");
    CHECK(message("f 1 2\n") == "x.obj: has no faces");
    CHECK(message("") == "x.obj: has no faces");
    CHECK(load_obj(folder.path / "none.obj").error().code == Errc::unreadable);
}

TEST_CASE("a file cut at any length is loaded or refused, never more") {
    const Folder folder;
    folder.put("m.mtl", "newmtl red\nKd 0.6 0.1 0.05\nmap_Kd -s 1 1 1 t.png\n");
    const std::string whole = std::string("mtllib m.mtl\n") + kSquare +
                              "o tile\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf -1 -2 -3\n";
    for (size_t length = 0; length <= whole.size(); ++length) {
        const auto scene = folder.load(std::string_view(whole).substr(0, length));
        if (!scene) continue;
        for (const Primitive& p : scene->meshes.at(0).primitives)
            for (const uvec3 t : p.triangles)
                REQUIRE(std::max({t.x, t.y, t.z}) < p.positions.size());
    }
    const std::string mtl = "newmtl red\nKd 0.6 0.1 0.05\nd 0.5\nmap_Kd -s 1 1 1 t.png\nKe 1 2 3\n";
    for (size_t length = 0; length <= mtl.size(); ++length) {
        folder.put("m.mtl", std::string_view(mtl).substr(0, length));
        REQUIRE(folder.load(whole));
    }
}

TEST_CASE("load_scene tells an OBJ by its text") {
    const Folder folder;
    folder.put("odd.txt", std::string(kSquare) + "f 1 2 3\n");
    const auto scene = load_scene(folder.path / "odd.txt");
    REQUIRE(scene);
    CHECK(scene->meshes.size() == 1);
}

TEST_CASE("a polygon that is not convex keeps its area and its side") {
    // An arrow head whose notch a fan from the first corner would cover.
    const std::vector<vec3> arrow = {{0, 0, 5}, {2, -2, 5}, {0, 3, 5}, {-2, -2, 5}};
    for (size_t start = 0; start < 4; ++start) {
        std::vector<vec3> corners = arrow;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start),
                    corners.end());
        const auto triangles = obj::triangulate(corners);
        CHECK(triangles.size() == 2);
        CHECK(area(corners, triangles) == doctest::Approx(6));
        for (const uvec3 t : triangles)
            CHECK(cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z > 0);
    }
}

TEST_CASE("any star-shaped polygon is cut into size - 2 triangles of its area") {
    const bool holds = rc::check([] {
        const int count = *rc::gen::inRange(3, 40);
        const float tilt = static_cast<float>(*rc::gen::inRange(0, 628)) / 100;
        std::vector<vec3> corners;
        double shoelace = 0;
        std::vector<vec2> flat;
        for (int i = 0; i < count; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
            const float radius = 1 + static_cast<float>(*rc::gen::inRange(0, 300)) / 100;
            flat.push_back({radius * std::cos(angle), radius * std::sin(angle)});
            corners.push_back({flat.back().x, flat.back().y * std::cos(tilt) + 100,
                               flat.back().y * std::sin(tilt) - 50});
        }
        for (size_t i = 0; i < flat.size(); ++i) {
            const vec2 a = flat[i], b = flat[(i + 1) % flat.size()];
            shoelace += static_cast<double>(a.x * b.y - b.x * a.y) / 2;
        }
        const auto triangles = obj::triangulate(corners);
        RC_ASSERT(triangles.size() == corners.size() - 2);
        RC_ASSERT(std::abs(area(corners, triangles) - shoelace) < 1e-3 * shoelace);
    });
    CHECK(holds);
}

TEST_CASE("published OBJ files load whole") {
    const fs::path root = scenes_folder();
    if (!is_here(root)) return;
    size_t loaded = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".obj" || entry.file_size() > (20u << 20)) continue;
        CAPTURE(entry.path().string());
        const auto scene = load_obj(entry.path());
        REQUIRE(scene);
        for (const Mesh& mesh : scene->meshes)
            for (const Primitive& p : mesh.primitives) REQUIRE_FALSE(p.triangles.empty());
        ++loaded;
    }
    MESSAGE(loaded << " OBJ files loaded");
}
