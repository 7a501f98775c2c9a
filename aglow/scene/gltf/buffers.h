// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace aglow::gltf {

/// A run of bytes inside a buffer that was checked to exist.
struct BufferView {
    std::span<const uint8_t> bytes;
    size_t stride = 0;  ///< 0: elements follow each other tightly
};

/// Every buffer's bytes, byteLength of them. Fallback buffers of EXT_meshopt_compression, which
/// need not exist, are left empty for decode_meshopt() to fill.
/// Errors  malformed (names the buffer), unreadable.
Result<std::vector<std::vector<uint8_t>>> read_buffers(
    const Json& root, std::optional<std::span<const uint8_t>> binary,
    const std::filesystem::path& folder);

/// Every buffer view, with its range checked. Views into fallback buffers are decompressed, and
/// the fallback buffers in `buffers` filled, so that any later reader may ignore the extension.
/// Lifetime  the views point into `buffers`.
/// Errors    malformed (names the buffer view).
Result<std::vector<BufferView>> read_buffer_views(const Json& root,
                                                  std::vector<std::vector<uint8_t>>& buffers);

}  // namespace aglow::gltf
