// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/pattern.mesh.h"
#include "aglow/render/gpu/raster/pattern.vert.h"
#include "aglow/render/gpu/raster/pattern_drawer.h"
#include "aglow/render/gpu/raster/scene_patches.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/shared/raster_pattern.h"

#include <utility>

namespace aglow::render::gpu {
namespace {

class PatternSource : public VertexSource {
public:
    PatternSource(const mesh::gpu::DeviceSurfaces& surfaces, ScenePatches patches,
                  PatternDrawer drawer, uint32_t segments, vk::Buffer patch_of, vk::Buffer geometry)
        : surfaces_(surfaces),
          patches_(std::move(patches)),
          drawer_(std::move(drawer)),
          segments_(segments),
          patch_of_(std::move(patch_of)),
          geometry_(std::move(geometry)) {}

    vk::GraphicsShaders shaders() const override {
        return drawer_.shaders(shaders::pattern_vert, shaders::pattern_mesh);
    }

    Status update(vk::Stream& stream, const Shot& /*shot*/) override {
        const vk::Stream::Scope scope(stream, "refine");
        const shared::RasterPattern geometry{patches_.patches().mesh(), patch_of_.address(),
                                             patches_.patches().levels(), drawer_.steps(),
                                             drawer_.triangles()};
        stream.upload(std::span(&geometry, 1), geometry_);
        patches_.update(stream, surfaces_);
        return {};
    }
    uint64_t geometry() const override { return geometry_.address(); }
    std::vector<FaceDraw> draws(Layer /*layer*/, std::span<const FaceRange> faces) const override {
        return face_draws(faces, pattern_draw({}, segments_));
    }
    void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const override {
        drawer_.draw(stream, pass, draw);
    }
    uint32_t displacement() const override { return patches_.patches().displacement(); }
    float overhang() const override { return patches_.overhang(); }

private:
    const mesh::gpu::DeviceSurfaces& surfaces_;
    ScenePatches patches_;
    PatternDrawer drawer_;
    uint32_t segments_;
    vk::Buffer patch_of_, geometry_;
};

}  // namespace

Result<std::unique_ptr<VertexSource>> make_pattern_source(vk::Stream& stream,
                                                          const mesh::gpu::DeviceSurfaces& surfaces,
                                                          const Scene& scene, const Surfaces& rest,
                                                          const RasterOptions& options) {
    const int segments = 1 << options.refinement.level;
    AG_TRY(ScenePatches patches,
           ScenePatches::create(stream, scene, rest, options.refinement, segments));
    AG_TRY(PatternDrawer drawer, PatternDrawer::create(stream, segments, options.mesh_shaders));
    AG_TRY(vk::Buffer patch_of,
           vk::make_buffer_of(stream, std::span<const uint32_t>(patches.control().patch_of),
                              "patches of triangles"));
    AG_TRY(vk::Buffer geometry, stream.make_buffer(sizeof(shared::RasterPattern), "patches"));
    return std::make_unique<PatternSource>(surfaces, std::move(patches), std::move(drawer),
                                           static_cast<uint32_t>(segments), std::move(patch_of),
                                           std::move(geometry));
}

}  // namespace aglow::render::gpu
