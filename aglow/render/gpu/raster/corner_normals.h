// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/render/gpu/raster/control_scene.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace aglow::render::gpu {

/// Normals that patches over a scene are made from, in each frame: those of the surfaces, but
/// smooth ones, which part at creases, of meshes that have none in the file.
class CornerNormals {
public:
    /// Synchronisation  ends without barrier.
    /// Errors           out_of_memory.
    static Result<CornerNormals> create(vk::Stream& stream, const ControlScene& control);

    /// From positions and normals of the surfaces, at these addresses.
    /// Result           address of the normals.
    /// Synchronisation  starts without barrier; the normals are there once it returns.
    uint64_t update(vk::Stream& stream, uint64_t positions, uint64_t normals) const;

    /// [half-edge] which of the normals a corner has.
    const std::vector<uint32_t>& number() const { return number_; }

private:
    CornerNormals() = default;

    std::optional<vk::Kernel> kernel_;  ///< none: all are those of the surfaces
    std::vector<uint32_t> number_;
    uint32_t count_ = 0;
    vk::Buffer source_, begin_, wedges_, normals_;
};

}  // namespace aglow::render::gpu
