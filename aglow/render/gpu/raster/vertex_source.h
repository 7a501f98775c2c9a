// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/render/gpu/raster/part_list.h"
#include "aglow/render/gpu/raster/projection.h"
#include "aglow/render/raster.h"
#include "aglow/shared/raster.h"
#include "aglow/vk/graphics_pipeline.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// What of the surfaces a frame shows, and from where.
struct Shot {
    const View& view;
    const Projection& projection;
    std::span<const std::vector<FaceRange>, kSolidLayers> layers;  ///< PartList::visible()
    std::span<const uint32_t> blended;                             ///< faces
};

/// What faces are drawn with and into.
struct SurfacePass {
    const vk::GraphicsPipeline& pipeline;  ///< of VertexSource::shaders()
    const vk::RenderTarget& target;
    shared::RasterArgs args;
};

/// Where the vertices of the scene's triangles ("faces") come from: from memory as they are posed,
/// from what these are refined to, or from a pattern that is drawn for each.
class VertexSource {
public:
    VertexSource() = default;
    VertexSource(const VertexSource&) = delete;
    VertexSource& operator=(const VertexSource&) = delete;
    virtual ~VertexSource() = default;

    /// All but the fragment shader, whose inputs are the outputs of mesh.vert.
    virtual vk::GraphicsShaders shaders() const = 0;

    /// Follows the surfaces, which have been posed, for the frame that is drawn next.
    /// Synchronisation  Starts and ends without barrier.
    virtual Status update(vk::Stream& stream, const Shot& shot) = 0;

    /// RasterArgs::geometry.
    virtual uint64_t geometry() const = 0;

    /// RasterArgs::order of solid layers; 0: faces come by their numbers.
    virtual uint64_t order() const { return 0; }

    /// How these runs of a solid layer's faces are drawn, all that the shot has of it; or so many
    /// blended ones as they are ordered, {{0, count}}.
    virtual std::vector<FaceDraw> draws(Layer layer, std::span<const FaceRange> faces) const = 0;
    virtual void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const = 0;

    /// Triangles that draws() makes.
    virtual uint64_t triangles(Layer layer, std::span<const FaceRange> faces) const;

    /// Pixels by which refined surfaces may be off; 0 where nobody set that.
    virtual float tolerance() const { return 0; }

    /// Constant 2 of the vertex or mesh shader, a shared::k...Displacement.
    virtual uint32_t displacement() const { return 0; }

    /// How far refined surfaces may leave the box about the coarse ones, as a share of its
    /// diagonal.
    virtual float overhang() const { return 0; }
};

/// The triangles as they are. `surfaces` must outlive it.
/// Errors  out_of_memory.
Result<std::unique_ptr<VertexSource>> make_plain_source(vk::Stream& stream,
                                                        const mesh::gpu::DeviceSurfaces& surfaces);

/// Subdivision surfaces that the triangles are control meshes of, meshes welded: their limit at all
/// points of a level. `rest` is what `surfaces` was made from; `surfaces` must outlive it.
/// Errors  bad_argument (more than 2^31 points), out_of_memory (says how much the level needs),
///         unsupported, device_lost.
Result<std::unique_ptr<VertexSource>> make_subdivision_source(
    vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces, const Scene& scene,
    const Surfaces& rest, const Refinement& refinement);

/// Each run of faces like that.
std::vector<FaceDraw> face_draws(std::span<const FaceRange> faces, FaceDraw like);

/// Curved patches over the triangles, meshes welded, a pattern of 2^level segments drawn for each;
/// flat ones where meshes name height maps, which displace them. `rest` is what `surfaces` was made
/// from; `surfaces` must outlive it.
/// Errors  unsupported, out_of_memory, device_lost; those of read_height_map().
Result<std::unique_ptr<VertexSource>> make_pattern_source(vk::Stream& stream,
                                                          const mesh::gpu::DeviceSurfaces& surfaces,
                                                          const Scene& scene, const Surfaces& rest,
                                                          const RasterOptions& options);

/// Likewise, each edge with as many segments as LevelOfDetail gives it in the frame.
Result<std::unique_ptr<VertexSource>> make_adaptive_source(
    vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces, const Scene& scene,
    const Surfaces& rest, const RasterOptions& options);

}  // namespace aglow::render::gpu
