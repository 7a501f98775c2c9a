// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

namespace aglow {

/// Folder of published scenes for tests, which may be absent: AGLOW_SCENES names it, else it is
/// looked for beside the project.
inline std::filesystem::path scenes_folder() {
    if (const char* folder = std::getenv("AGLOW_SCENES")) return folder;
    return AGLOW_SOURCE_DIR "/../shared/scenes";
}

/// Whether a file or folder of theirs is there; a test that says no is skipped with a message.
inline bool is_here(const std::filesystem::path& path) {
    if (std::filesystem::exists(path)) return true;
    MESSAGE("skipped: " << path.string() << " is not here");
    return false;
}

}  // namespace aglow
