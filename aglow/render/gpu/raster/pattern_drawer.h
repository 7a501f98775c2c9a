// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/refine/gpu/device_patches.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/render/raster.h"
#include "aglow/vk/graphics_pipeline.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <span>

namespace aglow::render::gpu {

/// Draws patterns of up to so many segments on faces: by groups of a mesh shader (see
/// shared::pattern_groups()) or, where there are none, as one instance of vertices for each face.
class PatternDrawer {
public:
    /// Ready once a barrier() follows.
    /// Errors  out_of_memory.
    static Result<PatternDrawer> create(vk::Stream& stream, int segments, MeshShaders mesh_shaders);

    vk::GraphicsShaders shaders(std::span<const uint32_t> vertex,
                                std::span<const uint32_t> mesh) const;
    void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const;

    uint64_t steps() const { return pattern_.steps.address(); }          ///< RasterPattern::steps
    uint64_t triangles() const { return pattern_.triangles.address(); }  ///< ... and ::triangles

private:
    PatternDrawer(refine::gpu::DevicePattern pattern, bool by_groups)
        : pattern_(std::move(pattern)), by_groups_(by_groups) {}

    refine::gpu::DevicePattern pattern_;
    bool by_groups_;
};

}  // namespace aglow::render::gpu
