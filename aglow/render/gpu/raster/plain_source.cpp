// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/mesh.vert.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/shared/raster.h"

#include <utility>

namespace aglow::render::gpu {
namespace {

class PlainSource : public VertexSource {
public:
    PlainSource(const mesh::gpu::DeviceSurfaces& surfaces, vk::Buffer geometry)
        : surfaces_(surfaces), geometry_(std::move(geometry)) {}

    vk::GraphicsShaders shaders() const override { return {.vertex = shaders::mesh_vert}; }

    Status update(vk::Stream& stream, const Shot& /*shot*/) override {
        const vk::Stream::Scope scope(stream, "pose");
        const shared::RasterGeometry geometry{surfaces_.positions(), surfaces_.normals(),
                                              surfaces_.indices()};
        stream.upload(std::span(&geometry, 1), geometry_);
        return {};
    }
    uint64_t geometry() const override { return geometry_.address(); }
    std::vector<FaceDraw> draws(Layer /*layer*/, std::span<const FaceRange> faces) const override {
        return face_draws(faces, {});
    }
    void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const override {
        stream.draw(pass.pipeline, pass.target, pass.args,
                    {3 * draw.places.first, 3 * draw.places.count});
    }

private:
    const mesh::gpu::DeviceSurfaces& surfaces_;
    vk::Buffer geometry_;
};

}  // namespace

Result<std::unique_ptr<VertexSource>> make_plain_source(vk::Stream& stream,
                                                        const mesh::gpu::DeviceSurfaces& surfaces) {
    AG_TRY(vk::Buffer geometry,
           stream.make_buffer(sizeof(shared::RasterGeometry), "triangles to draw"));
    return std::make_unique<PlainSource>(surfaces, std::move(geometry));
}

}  // namespace aglow::render::gpu
