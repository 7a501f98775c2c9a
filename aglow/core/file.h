// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace aglow {

/// Whole file as bytes. Errors: unreadable (missing, a folder, a device, or larger than 16 GiB).
Result<std::vector<uint8_t>> read_file(const std::filesystem::path& path);

/// Writes to a temporary file in the same folder, flushes, and renames it over `path`: a killed
/// or failed write never leaves a half-written file and never damages an existing one.
/// Errors: unreadable.
Status write_file(const std::filesystem::path& path, std::span<const uint8_t> bytes);
Status write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace aglow
