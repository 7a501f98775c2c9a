// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace aglow::gltf {

/// The two parts of a glTF file: its JSON text, and in a GLB file the binary chunk.
struct Container {
    std::string json;
    std::optional<std::span<const uint8_t>> binary;  ///< into the bytes given
};

/// True for the first bytes of a GLB file.
bool is_glb(std::span<const uint8_t> bytes);
/// True where the first byte that is no white space (nor byte order mark) opens a JSON object.
bool is_json(std::span<const uint8_t> bytes);

/// Errors  malformed: a header or chunk that contradicts the length of the file.
/// Source  glTF 2.0 specification, section 4.4.
Result<Container> split(std::span<const uint8_t> bytes);

}  // namespace aglow::gltf
