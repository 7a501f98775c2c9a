// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/lod.h"
#include "aglow/refine/pattern.h"
#include "aglow/render/gpu/raster/adaptive.mesh.h"
#include "aglow/render/gpu/raster/adaptive.vert.h"
#include "aglow/render/gpu/raster/face_bins.h"
#include "aglow/render/gpu/raster/hidden_edges.h"
#include "aglow/render/gpu/raster/pattern_drawer.h"
#include "aglow/render/gpu/raster/scene_patches.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/shared/raster_pattern.h"

#include <algorithm>
#include <utility>

namespace aglow::render::gpu {
namespace {

constexpr float kNearest = 1e-3f;  // of what is drawn: what is nearer gets no finer

/// [face of the control scene] Are their backs never drawn?
std::vector<uint8_t> one_sided_faces(const Scene& scene, const Surfaces& rest,
                                     const ControlScene& control) {
    std::vector<uint8_t> one_sided(control.topology.face_count(), 1);
    for (const SurfacePart& part : rest.parts) {
        if (part.material < 0 || !scene.materials[static_cast<size_t>(part.material)].double_sided)
            continue;
        for (uint32_t i = 0; i < part.triangle_count; ++i)
            if (const uint32_t f = control.patch_of[part.first_triangle + i]; f != kNone)
                one_sided[f] = 0;
    }
    return one_sided;
}

Viewpoint viewpoint_of(const View& view, float size) {
    const shared::CameraView camera = view.shared_view();
    Viewpoint eye;
    eye.perspective = view.perspective;
    eye.position = camera.to_world.t;
    eye.direction = camera.to_world.z * -1.0f;
    eye.pixels_per_metre = 0.5f * std::max(static_cast<float>(view.width) / view.half_width,
                                           static_cast<float>(view.height) / view.half_height);
    eye.nearest = size * kNearest;
    return eye;
}

float size_of(const std::vector<vec3>& positions) {
    Box box;
    for (const vec3 p : positions) box.add(p);
    return box.empty() ? 1 : length(box.size());
}

class AdaptiveSource : public VertexSource {
public:
    AdaptiveSource(const mesh::gpu::DeviceSurfaces& surfaces, ScenePatches patches,
                   std::vector<uint8_t> one_sided, const LodOptions& options, PatternDrawer drawer)
        : surfaces_(surfaces),
          patches_(std::move(patches)),
          one_sided_(std::move(one_sided)),
          details_(patches_.details()),
          reach_(patches_.reach()),
          lod_(options),
          drawer_(std::move(drawer)) {}

    Status make_buffers(vk::Stream& stream);
    vk::GraphicsShaders shaders() const override {
        return drawer_.shaders(shaders::adaptive_vert, shaders::adaptive_mesh);
    }
    Status update(vk::Stream& stream, const Shot& shot) override;
    uint64_t geometry() const override { return geometry_.address(); }
    uint64_t order() const override { return faces_.address(); }
    std::vector<FaceDraw> draws(Layer layer, std::span<const FaceRange> faces) const override;
    void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const override {
        drawer_.draw(stream, pass, draw);
    }
    uint64_t triangles(Layer layer, std::span<const FaceRange> faces) const override;
    float tolerance() const override { return tolerance_; }
    uint32_t displacement() const override { return patches_.patches().displacement(); }
    float overhang() const override { return patches_.overhang(); }

private:
    void choose_blended(const FaceSizes& sizes, std::span<const uint32_t> blended);

    const mesh::gpu::DeviceSurfaces& surfaces_;
    ScenePatches patches_;
    std::vector<uint8_t> one_sided_;   // [face]
    std::vector<EdgeDetail> details_;  // [edge], or empty
    std::vector<float> reach_;         // [face], or empty
    LevelOfDetail lod_;
    PatternDrawer drawer_;
    vk::Buffer patch_of_, geometry_, faces_;
    FaceBins bins_;
    uint32_t blended_segments_ = 0;
    uint64_t blended_triangles_ = 0;
    float tolerance_ = 0;
};

Status AdaptiveSource::make_buffers(vk::Stream& stream) {
    AG_TRY(patch_of_,
           vk::make_buffer_of(stream, std::span<const uint32_t>(patches_.control().patch_of),
                              "patches of triangles"));
    AG_TRY(faces_, stream.make_buffer(patches_.control().patch_of.size() * sizeof(uint32_t),
                                      "triangles by their patterns"));
    AG_TRY(geometry_, stream.make_buffer(sizeof(shared::RasterPattern), "patches"));
    const shared::RasterPattern geometry{patches_.patches().mesh(), patch_of_.address(),
                                         patches_.patches().levels(), drawer_.steps(),
                                         drawer_.triangles()};
    stream.upload(std::span(&geometry, 1), geometry_);
    return {};
}

/// All blended faces are drawn with the largest of their patterns, so that they stay in order; what
/// is beyond a face's own folds onto its rim.
void AdaptiveSource::choose_blended(const FaceSizes& sizes, std::span<const uint32_t> blended) {
    blended_segments_ = 1;
    blended_triangles_ = 0;
    for (const uint32_t face : blended) {
        blended_segments_ = std::max<uint32_t>(blended_segments_, sizes.segments[face]);
        blended_triangles_ += sizes.triangles[face];
    }
}

Status AdaptiveSource::update(vk::Stream& stream, const Shot& shot) {
    PatchControl control;
    {
        const vk::Stream::Scope scope(stream, "refine");
        patches_.update(stream, surfaces_);
        AG_TRY(control, patches_.patches().download_control(stream));
    }
    const vk::Stream::Scope scope(stream, "levels");
    const Topology& topology = patches_.control().topology;
    const std::vector<uint8_t> hidden =
        hidden_edges(topology, control, one_sided_, reach_, shot.projection);
    const LevelOfDetail::Choice choice = lod_.choose(
        topology, control, viewpoint_of(shot.view, size_of(control.positions)), {hidden, details_});
    tolerance_ = choice.tolerance;
    patches_.set_levels(stream, choice.levels);
    const FaceSizes sizes = face_sizes(topology, patches_.control().patch_of, choice.levels);
    bins_ = face_bins(sizes, shot.layers);
    choose_blended(sizes, shot.blended);
    stream.upload(std::span<const uint32_t>(bins_.faces), faces_);
    return {};
}

std::vector<FaceDraw> AdaptiveSource::draws(Layer layer, std::span<const FaceRange> faces) const {
    if (layer == Layer::blended) return {pattern_draw(faces[0], blended_segments_)};
    return bins_.draws[static_cast<size_t>(layer)];
}

uint64_t AdaptiveSource::triangles(Layer layer, std::span<const FaceRange> /*faces*/) const {
    return layer == Layer::blended ? blended_triangles_
                                   : bins_.triangles[static_cast<size_t>(layer)];
}

}  // namespace

Result<std::unique_ptr<VertexSource>> make_adaptive_source(
    vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces, const Scene& scene,
    const Surfaces& rest, const RasterOptions& options) {
    AG_TRY(ScenePatches patches, ScenePatches::create(stream, scene, rest, options.refinement, 1));
    AG_TRY(PatternDrawer drawer,
           PatternDrawer::create(stream, kMostAdaptiveSegments, options.mesh_shaders));
    std::vector<uint8_t> one_sided = one_sided_faces(scene, rest, patches.control());
    LodOptions lod;
    lod.tolerance = options.refinement.tolerance;
    lod.budget = options.refinement.budget;
    auto source = std::make_unique<AdaptiveSource>(surfaces, std::move(patches),
                                                   std::move(one_sided), lod, std::move(drawer));
    AG_CHECK(source->make_buffers(stream));
    return source;
}

}  // namespace aglow::render::gpu
