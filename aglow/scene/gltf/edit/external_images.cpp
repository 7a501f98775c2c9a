// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/external_images.h"

#include "aglow/core/file.h"
#include "aglow/scene/gltf/edit/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace aglow::gltf::edit {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& path, std::span<const uint8_t> bytes) {
    std::error_code error;
    if (fs::file_size(path, error) != bytes.size() || error) return false;
    const auto content = read_file(path);
    return content && std::ranges::equal(*content, bytes);
}

}  // namespace

std::vector<ImageCopy> relocate_images(Document& document, const fs::path& scene) {
    std::vector<ImageCopy> copies;
    std::set<fs::path> taken;
    const size_t count = list_of(document.json, "images").size();
    for (size_t i = 0; i < count && i < document.source->images.size(); ++i) {
        Json& image = document.json["images"][i];
        const auto& bytes = document.source->images[i];
        if (!image.contains("uri") || bytes.empty()) continue;
        if (static_cast<int>(i) == document.own_image) continue;
        const std::string uri = image["uri"].get<std::string>();
        if (uri.starts_with("data:")) continue;
        const fs::path named = path_of_uri(uri);
        fs::path target = scene.parent_path() / named;
        if (!named.empty() && (taken.contains(target) || holds(target, bytes))) continue;
        if (named.empty() || fs::exists(target)) {
            const std::string name = fmt::format("{}.image{}{}", scene.stem().string(), i,
                                                 fs::path(uri).extension().string());
            image["uri"] = to_uri(name);
            target = scene.parent_path() / name;
        }
        taken.insert(target);
        copies.push_back({target, bytes});
    }
    return copies;
}

}  // namespace aglow::gltf::edit
