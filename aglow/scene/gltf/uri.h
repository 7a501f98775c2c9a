// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace aglow::gltf {

/// Bytes that a URI of a buffer or image stands for: a data: URI, or a file in `folder` or below.
/// Errors  malformed   a data: URI that does not decode
///         unreadable  the file is missing, or the URI is absolute, has a scheme, leaves the
///                     folder, holds control characters, or the folder is empty
Result<std::vector<uint8_t>> read_uri(std::string_view uri, const std::filesystem::path& folder);

/// Path below the folder that a relative URI names, with percent escapes resolved.
/// Errors  unreadable, as above.
Result<std::filesystem::path> relative_path(std::string_view uri);

/// Payload of a data: URI, base64 or percent-coded. Errors: malformed.
Result<std::vector<uint8_t>> decode_data_uri(std::string_view uri);

}  // namespace aglow::gltf
