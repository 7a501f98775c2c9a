// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/scene_files.h"

#include "aglow/scene/gltf/edit/external_images.h"
#include "aglow/scene/gltf/edit/pack.h"

#include <algorithm>
#include <cctype>

namespace aglow::gltf::edit {

namespace fs = std::filesystem;

Result<SceneFiles> scene_files(const fs::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".glb" && ending != ".gltf")
        return fail(Errc::bad_argument, "a scene is written as .glb or .gltf", path.string());
    return SceneFiles{path, path.parent_path() / (path.stem().string() + ".bin"), ending == ".glb"};
}

Status add_scene(Document& document, const SceneFiles& files, OutputSet& outputs) {
    if (files.binary) {
        embed_images(document);
        sweep_free_slots(document);
        const auto binary = merge_buffers(document);
        AG_TRY(const auto glb, to_glb_bytes(document.json, binary));
        return outputs.add(files.scene, glb);
    }
    const auto copies = relocate_images(document, files.scene);
    sweep_free_slots(document);
    const auto binary = merge_buffers(document);
    if (!binary.empty())
        document.json["buffers"][0]["uri"] = to_uri(files.buffer.filename().string());
    AG_CHECK(outputs.add(files.scene, bytes_of(to_text(document.json, 2) + "\n")));
    if (!binary.empty()) AG_CHECK(outputs.add(files.buffer, binary));
    for (const auto& copy : copies) AG_CHECK(outputs.add(copy.target, copy.bytes));
    return {};
}

Status protect_input(const Scene& scene, const Document& document, const SceneFiles& files,
                     const std::vector<fs::path>& others) {
    const auto& source = scene.source;
    if (!source || source->folder.empty() || files.scene.filename().string() == scene.name)
        return {};
    std::vector<fs::path> outputs = others;
    outputs.push_back(files.buffer);
    for (const char* key : {"buffers", "images"}) {
        for (const Json& element : list_of(document.json, key)) {
            const auto uri = element.find("uri");
            if (uri == element.end()) continue;
            const fs::path named = path_of_uri(uri->get<std::string>());
            if (named.empty()) continue;
            for (const fs::path& output : outputs) {
                std::error_code ignored;
                if (fs::equivalent(source->folder / named, output, ignored))
                    return fail(Errc::bad_argument,
                                "it belongs to the input; choose another output name",
                                output.string());
            }
        }
    }
    return {};
}

std::span<const uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

}  // namespace aglow::gltf::edit
