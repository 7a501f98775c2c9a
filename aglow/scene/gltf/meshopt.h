// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/json.h"

#include <cstdint>
#include <span>
#include <string>

namespace aglow::gltf {

/// One compressed buffer view of EXT_meshopt_compression.
struct MeshoptBlock {
    std::span<const uint8_t> bytes;
    size_t count = 0;    ///< elements
    size_t stride = 0;   ///< bytes per element, decompressed
    std::string mode;    ///< ATTRIBUTES, TRIANGLES or INDICES
    std::string filter;  ///< NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL
};

/// Whether mode, filter, stride and count belong together, and the bytes can hold that much.
/// Errors  malformed; names the element of `owner`.
Status check(const MeshoptBlock& block, const Json& owner);

/// Decompresses a checked block into `out`, count * stride bytes.
/// Errors  malformed; names the element of `owner`.
Status decode(const MeshoptBlock& block, std::span<uint8_t> out, const Json& owner);

}  // namespace aglow::gltf
