// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tinyobj {
struct material_t;
}

namespace aglow::obj {

/// Path below `folder` that an OBJ or MTL file names, with either kind of slash.
/// Errors  unreadable: it is empty, absolute, leaves the folder or holds control characters.
Result<std::filesystem::path> path_in_folder(std::string name, const std::filesystem::path& folder);

/// Adds the materials of MTL files to a scene, each with the textures it names.
class MaterialLibrary {
public:
    MaterialLibrary(Scene& scene, std::filesystem::path folder)
        : scene_(scene), folder_(std::move(folder)) {}

    /// Replaces what earlier files said about materials of the same name.
    void add(const tinyobj::material_t& material);
    /// Index of a material by name, -1 and a warning (once) where there is none.
    int find(const std::string& name);

private:
    TextureRef texture(const std::string& file, const std::string& material);

    Scene& scene_;
    std::filesystem::path folder_;
    std::map<std::string, int> index_of_;
    std::map<std::string, int> texture_of_;  ///< by file name; -1 where it could not be loaded
};

}  // namespace aglow::obj
