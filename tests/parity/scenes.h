// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/testing/scenes_folder.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aglow::testing {

/// A scene to trace rays in, all of it opaque.
struct TestScene {
    std::string name;
    Scene scene;
    Surfaces surfaces;
};

inline TestScene opaque_scene(std::string name, Scene scene) {
    for (Material& material : scene.materials) material.alpha_mode = AlphaMode::opaque;
    Surfaces surfaces = pose(scene);
    return {std::move(name), std::move(scene), std::move(surfaces)};
}

/// Four scenes made by code, and two rooms of files where those are there.
inline std::vector<TestScene> test_scenes() {
    std::vector<TestScene> scenes;
    for (const char* name : {"cornell-box", "living-room", "corridor", "stress:20000"})
        scenes.push_back(opaque_scene(name, *builtin_scene(name)));
    const std::filesystem::path folder = scenes_folder();
    for (const char* file :
         {"rooms/godot-living-room/living_room.glb", "rooms/playcanvas-house/house.glb"})
        if (auto scene = load_scene(folder / file))
            scenes.push_back(opaque_scene(file, std::move(*scene)));
    return scenes;
}

}  // namespace aglow::testing
