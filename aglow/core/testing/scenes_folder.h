// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>
#include <filesystem>

namespace aglow {

/// Folder of published scenes for tests and benchmarks, which may be absent: AGLOW_SCENES names it,
/// else it is looked for beside the project.
inline std::filesystem::path scenes_folder() {
    if (const char* folder = std::getenv("AGLOW_SCENES")) return folder;
    return AGLOW_SOURCE_DIR "/../shared/scenes";
}

}  // namespace aglow
