// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/file.h"
#include "aglow/scene/gltf/test_files.h"

#include <doctest/doctest.h>
#include <unistd.h>

using namespace aglow;
using namespace aglow::gltf_test;
namespace fs = std::filesystem;

namespace {

/// Writes `bytes` to a file of that name, loads it, and removes it.
Result<Scene> load_as(const std::string& name, const Bytes& bytes) {
    const fs::path folder =
        fs::temp_directory_path() / ("aglow_load_test_" + std::to_string(getpid()));
    fs::create_directories(folder);
    REQUIRE(write_file(folder / name, bytes).has_value());
    auto scene = load_scene(folder / name);
    fs::remove_all(folder);
    return scene;
}

Bytes text(std::string_view content) { return Bytes(content.begin(), content.end()); }

}  // namespace

TEST_CASE("files are told apart by content, not by their ending") {
    const Bytes obj = text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto glb_scene = load_as("odd.obj", triangle_file());
    const auto obj_scene = load_as("odd.glb", obj);
    const auto json_scene = load_as("odd.png", text(" \n\t" + document(R"("nodes": [{}])")));
    const auto bom_scene = load_as("odd.bin", text("\xef\xbb\xbf" + document(R"("nodes": [{}])")));
    for (const auto* scene : {&glb_scene, &obj_scene, &json_scene, &bom_scene})
        CHECK_MESSAGE(scene->has_value(), (*scene ? "" : to_string(scene->error())));
    REQUIRE(glb_scene.has_value());
    REQUIRE(obj_scene.has_value());
    CHECK(glb_scene->name == "odd.obj");
    CHECK(glb_scene->meshes[0].primitives[0].triangles.size() == 1);
    CHECK(obj_scene->meshes[0].primitives[0].triangles.size() == 1);
}

TEST_CASE("what is no scene is malformed, what is no file is unreadable") {
    const auto junk = load_as("junk.glb", Bytes{1, 0, 2, 0, 3});
    REQUIRE_FALSE(junk.has_value());
    CHECK(to_string(junk.error()) == "junk.glb: the file is neither glTF, GLB nor OBJ");
    CHECK(junk.error().code == Errc::malformed);
    CHECK(load_as("empty.glb", {}).error().code == Errc::malformed);
    const auto missing = load_scene("no/such/file.glb");
    REQUIRE_FALSE(missing.has_value());
    CHECK(missing.error().code == Errc::unreadable);
    CHECK(load_scene(fs::temp_directory_path()).error().code == Errc::unreadable);
    CHECK(load_scene("/dev/zero").error().code == Errc::unreadable);
}
