// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"

namespace aglow::gltf::edit {

/// Media type by the first bytes; empty for what is no known image.
std::string image_type(std::span<const uint8_t> bytes);

/// Moves every image that lies outside the document into it.
void embed_images(Document& document);

/// Lays all buffers out as one: rewrites bufferViews and `buffers`, and gives the bytes. Runs of
/// bytes that no bufferView shows are left out (where no unknown extension could need them).
std::vector<uint8_t> merge_buffers(Document& document);

/// GLB of the document. Errors: bad_argument (more than 4 GiB).
Result<std::vector<uint8_t>> to_glb_bytes(const Json& json, std::span<const uint8_t> binary);

/// JSON text, indented; names that are not UTF-8 have the bytes replaced.
std::string to_text(const Json& json, int indent);

/// A file name as a relative URI (RFC 3986: other bytes than the unreserved ones are escaped).
std::string to_uri(std::string_view name);
/// The path that a relative URI names; empty where it is a data: URI, has a scheme, is absolute or
/// leaves its folder.
std::filesystem::path path_of_uri(std::string_view uri);

}  // namespace aglow::gltf::edit
