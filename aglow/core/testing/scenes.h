// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/testing/scenes_folder.h"

#include <doctest/doctest.h>

#include <filesystem>

namespace aglow {

/// Whether a published file or folder is there; a test that hears no is skipped with a message.
inline bool is_here(const std::filesystem::path& path) {
    if (std::filesystem::exists(path)) return true;
    MESSAGE("skipped: " << path.string() << " is not here");
    return false;
}

}  // namespace aglow
