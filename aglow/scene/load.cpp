// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/load.h"

#include "aglow/core/file.h"
#include "aglow/scene/gltf/container.h"
#include "aglow/scene/obj/obj.h"

#include <algorithm>

namespace aglow {
namespace {

/// OBJ is text; a NUL byte early on tells of anything else.
bool is_text(std::span<const uint8_t> bytes) {
    constexpr size_t kProbe = 4096;
    const auto probe = bytes.first(std::min(bytes.size(), kProbe));
    return !probe.empty() && std::find(probe.begin(), probe.end(), 0) == probe.end();
}

/// Folder of a file for looking up what it names; never empty.
std::filesystem::path folder_of(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.parent_path();
    return folder.empty() ? std::filesystem::path(".") : folder;
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& path) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    const std::string name = path.filename().string();
    if (gltf::is_glb(bytes) || gltf::is_json(bytes))
        return load_gltf(std::as_bytes(std::span(bytes)), name, folder_of(path));
    if (is_text(bytes)) return load_obj(path);
    return fail(Errc::malformed, "the file is neither glTF, GLB nor OBJ", name);
}

}  // namespace aglow
