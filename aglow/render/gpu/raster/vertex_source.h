// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/render/raster.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <memory>
#include <span>

namespace aglow::render::gpu {

/// Where the vertices of the scene's triangles ("faces") come from: from memory as they are posed,
/// from what these are refined to, or from a pattern that is drawn for each. Outputs of the vertex
/// shader are those of mesh.vert.
class VertexSource {
public:
    VertexSource() = default;
    VertexSource(const VertexSource&) = delete;
    VertexSource& operator=(const VertexSource&) = delete;
    virtual ~VertexSource() = default;

    virtual std::span<const uint32_t> vertex_shader() const = 0;

    /// Follows the surfaces, which have been posed.
    /// Synchronisation  Starts and ends without barrier.
    virtual Status update(vk::Stream& stream) = 0;

    /// RasterArgs::geometry.
    virtual uint64_t geometry() const = 0;

    /// What draws a run of faces: the vertex shader finds their places from gl_VertexIndex and
    /// gl_InstanceIndex, and the faces at these from face_at().
    virtual vk::Draw draw(uint32_t first_face, uint32_t face_count) const = 0;

    /// How far refined surfaces may leave the box about the coarse ones, as a share of its
    /// diagonal.
    virtual float overhang() const { return 0; }
};

/// The triangles as they are. `surfaces` must outlive it.
/// Errors  out_of_memory.
Result<std::unique_ptr<VertexSource>> make_plain_source(vk::Stream& stream,
                                                        const mesh::gpu::DeviceSurfaces& surfaces);

/// Curved patches over the triangles, meshes welded, a pattern of 2^level segments drawn for each.
/// `rest` is what `surfaces` was made from; `surfaces` must outlive it.
/// Errors  out_of_memory, device_lost.
Result<std::unique_ptr<VertexSource>> make_pattern_source(vk::Stream& stream,
                                                          const mesh::gpu::DeviceSurfaces& surfaces,
                                                          const Scene& scene, const Surfaces& rest,
                                                          const Refinement& refinement);

}  // namespace aglow::render::gpu
