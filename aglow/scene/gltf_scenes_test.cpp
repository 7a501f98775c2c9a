// SPDX-License-Identifier: Apache-2.0
// Real files: each loads, keeps the promises of Scene, and holds the bounds it says it has.
#include "aglow/core/file.h"
#include "aglow/core/testing/scenes.h"
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf_source.h"

#include <doctest/doctest.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace aglow;
using namespace aglow::gltf_test;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> scene_files() {
    std::vector<fs::path> files;
    if (!fs::is_directory(scenes_folder())) return files;
    for (const auto& entry : fs::recursive_directory_iterator(scenes_folder()))
        if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

Result<Scene> load_file(const fs::path& path) {
    const auto bytes = read_file(path);
    REQUIRE(bytes.has_value());
    return load_gltf(std::as_bytes(std::span(*bytes)), path.filename().string(),
                     path.parent_path());
}

/// Every POSITION accessor states the bounds of its values: the file's own oracle. Flat shading
/// leaves vertices out that no triangle uses, so such bounds may only shrink.
void check_bounds(const Scene& scene) {
    const auto json = nlohmann::json::parse(scene.source->json);
    for (size_t m = 0; m < scene.meshes.size(); ++m)
        for (size_t p = 0; p < scene.meshes[m].primitives.size(); ++p) {
            const Primitive& primitive = scene.meshes[m].primitives[p];
            if (primitive.positions.empty()) continue;
            const auto& accessor =
                json["accessors"]
                    [json["meshes"][m]["primitives"][p]["attributes"]["POSITION"].get<size_t>()];
            if (accessor["componentType"] != 5126) continue;  // bounds of raw integers
            // Bounds of compressed data include what quantisation may add.
            const bool compressed = json["meshes"][m]["primitives"][p].contains("extensions");
            Box box;
            for (const vec3 v : primitive.positions) box.add(v);
            const std::array<float, 3> lo{box.lo.x, box.lo.y, box.lo.z};
            const std::array<float, 3> hi{box.hi.x, box.hi.y, box.hi.z};
            for (size_t axis = 0; axis < 3; ++axis) {
                const float low = accessor["min"][axis].get<float>();
                const float high = accessor["max"][axis].get<float>();
                const float rounding = 1e-5f * std::max({std::abs(low), std::abs(high), 1e-6f});
                CHECK(lo[axis] >= low - rounding);
                CHECK(hi[axis] <= high + rounding);
                if (!primitive.source_vertex.empty() || compressed) continue;
                CHECK(lo[axis] <= low + rounding);
                CHECK(hi[axis] >= high - rounding);
            }
        }
}

/// Every array has its promised length and every index exists.
void check_promises(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives) {
            const size_t count = primitive.positions.size();
            CHECK(primitive.normals.size() == count);
            for (const auto& set : primitive.texcoords) CHECK(set.size() == count);
            CHECK((primitive.colors.empty() || primitive.colors.size() == count));
            CHECK(primitive.joints.size() == count * static_cast<size_t>(primitive.influences));
            CHECK(primitive.weights.size() == primitive.joints.size());
            CHECK(primitive.targets.size() == mesh.weights.size());
            uint32_t largest = 0;
            for (const uvec3 t : primitive.triangles) largest = std::max({largest, t.x, t.y, t.z});
            CHECK((primitive.triangles.empty() || largest < count));
            float worst = 0;
            for (const vec3 n : primitive.normals) worst = std::max(worst, std::abs(length(n) - 1));
            CHECK(worst < 1e-5f);
        }
    for (const Material& material : scene.materials)
        if (material.base_color_texture.texture >= 0) {
            const auto texture = static_cast<size_t>(material.base_color_texture.texture);
            CHECK(!scene.images[static_cast<size_t>(scene.textures[texture].image)].rgba.empty());
        }
}

}  // namespace

TEST_CASE(
    "every public test scene loads, keeps the promises of Scene, and has the bounds it states") {
    const std::vector<fs::path> files = scene_files();
    if (files.empty()) {
        MESSAGE("skipped: no test scenes at " << scenes_folder().string());
        return;
    }
    for (const fs::path& path : files) {
        CAPTURE(path.string());
        const auto scene = load_file(path);
        CHECK_MESSAGE(scene.has_value(), (scene ? "" : to_string(scene.error())));
        if (!scene) continue;
        CHECK(scene->source != nullptr);
        check_promises(*scene);
        check_bounds(*scene);
    }
}

TEST_CASE("the same box lies in the plain and in the Draco file") {
    const fs::path plain = scenes_folder() / "khronos/Box/Box.glb";
    const fs::path draco = scenes_folder() / "khronos/Box-Draco/Box.gltf";
    if (!fs::exists(plain) || !fs::exists(draco)) {
        MESSAGE("skipped: no test scenes at " << scenes_folder().string());
        return;
    }
    const auto a = load_file(plain), b = load_file(draco);
    REQUIRE(a.has_value());
    REQUIRE(b.has_value());
    for (const Scene* scene : {&*a, &*b}) {
        const Primitive& box = scene->meshes[0].primitives[0];
        CHECK(box.triangles.size() == 12);
        double area = 0;  // of the unit cube: 6 m^2
        double volume = 0;
        for (const uvec3 t : box.triangles) {
            const vec3 p = box.positions[t.x], q = box.positions[t.y], r = box.positions[t.z];
            const vec3 normal = cross(q - p, r - p);
            area += length(normal) / 2;
            volume += dot(p, cross(q, r)) / 6;
            CHECK(dot(normal, box.normals[t.x]) > 0.99f * length(normal));
        }
        CHECK(area == doctest::Approx(6).epsilon(1e-3));
        CHECK(volume == doctest::Approx(1).epsilon(1e-3));
    }
}

TEST_CASE("all primitive modes of a public test file draw the square they show") {
    const fs::path path = scenes_folder() / "khronos/MeshPrimitiveModes/MeshPrimitiveModes.gltf";
    if (!fs::exists(path)) {
        MESSAGE("skipped: no test scenes at " << scenes_folder().string());
        return;
    }
    const auto scene = load_file(path);
    REQUIRE(scene.has_value());
    for (const Mesh& mesh : scene->meshes)
        for (const Primitive& primitive : mesh.primitives)
            for (const uvec3 t : primitive.triangles) {
                const vec3 p = primitive.positions[t.x];
                const vec3 normal =
                    cross(primitive.positions[t.y] - p, primitive.positions[t.z] - p);
                CHECK(normal.z > 0);  // every triangle faces the camera
            }
}
