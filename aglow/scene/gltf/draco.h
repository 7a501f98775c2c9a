// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aglow::gltf {

/// An attribute asked of compressed data.
struct DracoRequest {
    std::string name;  ///< `POSITION`
    uint32_t id = 0;   ///< Draco's unique id
    int components = 3;
    float one = 1;  ///< integer that stands for 1 where the accessor is normalised, else 1
};

struct DracoMesh {
    size_t vertex_count = 0;
    std::vector<uint32_t> indices;           ///< [3 * triangle_count], below vertex_count
    std::vector<std::vector<float>> values;  ///< [request][vertex_count * components], finite
};

/// Decodes KHR_draco_mesh_compression data.
/// Errors  malformed (the message starts with `element`), out_of_memory.
Result<DracoMesh> decode_draco(std::span<const uint8_t> bytes,
                               std::span<const DracoRequest> requests, const std::string& element);

}  // namespace aglow::gltf
