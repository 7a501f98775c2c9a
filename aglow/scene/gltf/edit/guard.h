// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

namespace aglow::gltf::edit {

/// The Result of `edit`, which edits the document of a scene and writes it to `path`. What that
/// throws becomes an error: of the scene where its document is not glTF, else of `path`.
/// Errors  malformed, unreadable, out_of_memory, those of `edit`
template <class Edit>
auto guarded(const Scene& scene, const std::filesystem::path& path, const Edit& edit)
    -> decltype(edit()) try {
    return edit();
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "no memory to write the scene", path.string());
} catch (const nlohmann::json::exception& error) {
    return fail(Errc::malformed, fmt::format("the source's JSON is not glTF: {}", error.what()),
                scene.name);
} catch (const std::filesystem::filesystem_error& error) {
    return fail(Errc::unreadable, error.what(), path.string());
} catch (const std::exception& error) {
    return fail(Errc::malformed, fmt::format("the source cannot be edited: {}", error.what()),
                scene.name);
}

}  // namespace aglow::gltf::edit
