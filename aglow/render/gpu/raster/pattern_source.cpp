// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_patches.h"
#include "aglow/render/gpu/raster/control_scene.h"
#include "aglow/render/gpu/raster/corner_normals.h"
#include "aglow/render/gpu/raster/pattern.vert.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/shared/raster_pattern.h"

#include <utility>

namespace aglow::render::gpu {
namespace {

using refine::gpu::DevicePatches;
using refine::gpu::DevicePattern;

class PatternSource : public VertexSource {
public:
    PatternSource(const mesh::gpu::DeviceSurfaces& surfaces, CornerNormals normals,
                  DevicePatches patches, DevicePattern pattern, vk::Buffer patch_of,
                  vk::Buffer geometry)
        : surfaces_(surfaces),
          normals_(std::move(normals)),
          patches_(std::move(patches)),
          pattern_(std::move(pattern)),
          patch_of_(std::move(patch_of)),
          geometry_(std::move(geometry)) {}

    std::span<const uint32_t> vertex_shader() const override { return shaders::pattern_vert; }

    Status update(vk::Stream& stream, const Shot& /*shot*/) override {
        const vk::Stream::Scope scope(stream, "refine");
        const shared::RasterPattern geometry{patches_.mesh(), patch_of_.address(),
                                             pattern_.steps.address(),
                                             static_cast<uint32_t>(pattern_.segments), 0};
        stream.upload(std::span(&geometry, 1), geometry_);
        patches_.update(stream, surfaces_.positions(),
                        normals_.update(stream, surfaces_.positions(), surfaces_.normals()));
        return {};
    }
    uint64_t geometry() const override { return geometry_.address(); }
    std::vector<vk::Draw> draws(Layer /*layer*/, std::span<const FaceRange> faces) const override {
        std::vector<vk::Draw> draws;
        for (const FaceRange& run : faces)
            draws.push_back(
                {0, 3 * pattern_.triangle_count, run.first, run.count, &pattern_.triangles});
        return draws;
    }
    float overhang() const override { return 0.5f; }  // control points are a third of an edge off

private:
    const mesh::gpu::DeviceSurfaces& surfaces_;
    CornerNormals normals_;
    DevicePatches patches_;
    DevicePattern pattern_;
    vk::Buffer patch_of_, geometry_;
};

}  // namespace

Result<std::unique_ptr<VertexSource>> make_pattern_source(vk::Stream& stream,
                                                          const mesh::gpu::DeviceSurfaces& surfaces,
                                                          const Scene& scene, const Surfaces& rest,
                                                          const Refinement& refinement) {
    AG_TRY(const ControlScene control, control_scene(scene, rest));
    refine::gpu::DevicePatchInput input;
    input.vertex_source = control.vertex_source;
    AG_TRY(CornerNormals normals, CornerNormals::create(stream, control));
    input.corner_normal = normals.number();
    if (refinement.kind == Refinement::Kind::tagged) input.tags = control.tags;
    AG_TRY(DevicePatches patches,
           DevicePatches::create(stream, control.topology, PatchOptions{}, input));
    AG_TRY(DevicePattern pattern,
           refine::gpu::upload_triangle_pattern(stream, 1 << refinement.level));
    AG_TRY(vk::Buffer patch_of,
           vk::make_buffer_of(stream, std::span<const uint32_t>(control.patch_of),
                              "patches of triangles"));
    AG_TRY(vk::Buffer geometry, stream.make_buffer(sizeof(shared::RasterPattern), "patches"));
    return std::make_unique<PatternSource>(surfaces, std::move(normals), std::move(patches),
                                           std::move(pattern), std::move(patch_of),
                                           std::move(geometry));
}

}  // namespace aglow::render::gpu
