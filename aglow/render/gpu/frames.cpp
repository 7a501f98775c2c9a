// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"

#include "aglow/accel/gpu/trace_scene.h"
#include "aglow/render/cpu/draw.h"
#include "aglow/render/gpu/device_footage.h"
#include "aglow/render/gpu/device_frames.h"
#include "aglow/render/gpu/motion_groups.h"
#include "aglow/render/gpu/wavefront.h"
#include "aglow/render/tables/resting_light.h"

#include <optional>
#include <utility>

namespace aglow {
namespace render::gpu {
namespace {

constexpr size_t kMostBodies = 256;  // that move stiffly and have a structure of their own

/// What is used of "grid", "grid2" and "bvh", joined by +.
std::string structure_names(uint32_t kinds) {
    std::string names;
    for (const auto& [kind, accel] : {std::pair{shared::kStructureGrid, Accel::grid},
                                      std::pair{shared::kStructureGrid2, Accel::grid2},
                                      std::pair{shared::kStructureBvh, Accel::bvh}})
        if (kinds & (1u << kind)) names += (names.empty() ? "" : "+") + std::string(name(accel));
    return names;
}

uint64_t whole(uvec2 words) { return uint64_t{words.y} << 32 | words.x; }

class GpuFrameRenderer : public DeviceFrameRenderer {
public:
    GpuFrameRenderer(vk::Stream stream, const Footage& footage)
        : DeviceFrameRenderer(std::move(stream)),
          scene_(footage.scene),
          lit_(footage.lit),
          options_(footage.options) {}

    Status prepare(Accel accel, const Monitor& monitor);
    std::string accel() const override { return structure_names(structure_->kinds()); }

private:
    Status make_footage(const MotionGroups& grouped, const EmitterTable& emitters,
                        const Monitor& monitor);
    Result<DrawnFrame> draw_frame(double time, const View& view, const Monitor& monitor) override;
    Status move(double time);
    WavefrontFrame frame_of(double time, const View& view) const;
    bool at_rest(double time) const { return time < 0 || !has_resting_; }

    const Scene& scene_;
    const Lit* lit_;
    RaysOptions options_;
    bool has_resting_ = false;  // baked light without what follows motion is known
    uint32_t seed_ = 0;
    std::vector<accel::gpu::Group> groups_;
    std::vector<uint32_t> part_of_group_;
    Accel asked_accel_ = Accel::automatic;
    std::optional<bool> built_at_rest_;
    std::optional<DeviceFootage> footage_;
    std::optional<accel::gpu::TraceScene> structure_;
    std::optional<Wavefront> wavefront_;
};

Status GpuFrameRenderer::make_footage(const MotionGroups& grouped, const EmitterTable& emitters,
                                      const Monitor& monitor) {
    Image resting;
    if (lit_ && has_motion(scene_) && !light_table(scene_, -1).lights.empty()) {
        AG_TRY(resting, resting_light(scene_, *lit_, monitor));
        has_resting_ = true;
    }
    AG_TRY(footage_,
           DeviceFootage::create(stream(), {.scene = scene_,
                                            .surfaces = grouped.surfaces,
                                            .source_of = grouped.source_of,
                                            .stored = lit_ ? &lit_->irradiance : nullptr,
                                            .resting = has_resting_ ? &resting : nullptr,
                                            .emitters = emitters,
                                            .sky = lit_ ? SkyTable{} : sky_table(scene_)}));
    return {};
}

Status GpuFrameRenderer::prepare(Accel accel, const Monitor& monitor) {
    AG_CHECK(cpu::check(options_));
    seed_ = draw_seed(options_);
    Surfaces rest = pose(scene_, -1, lit_ ? &lit_->atlas : nullptr);
    EmitterTable emitters;
    if (!lit_) emitters = emitter_table(scene_, rest);
    const auto motions = mesh::gpu::classify_parts(scene_, rest.parts);
    const MotionGroups grouped = motion_groups(std::move(rest), motions, kMostBodies);
    const std::vector<uint32_t> place_of = grouped.place_of();
    for (uint32_t& triangle : emitters.triangles) triangle = place_of[triangle];
    AG_CHECK(make_footage(grouped, emitters, monitor));
    part_of_group_ = grouped.part_of;
    groups_ = grouped.groups;
    asked_accel_ = accel;
    AG_TRY(structure_, accel::gpu::TraceScene::create(gpu(), groups_, asked_accel_, 0));
    AG_TRY(wavefront_, Wavefront::create(stream(),
                                         {.kinds = structure_->kinds(),
                                          .alpha = footage_->tables().has_alpha(),
                                          .textured = footage_->tables().has_textures()},
                                         filter_offsets(options_)));
    return stream().finish();
}

/// Brings surfaces and structure to `time`. What stands still at all times may stand elsewhere in
/// the rest pose.
Status GpuFrameRenderer::move(double time) {
    const bool rest = time < 0;
    if (built_at_rest_.value_or(rest) != rest) {
        AG_TRY(structure_, accel::gpu::TraceScene::create(gpu(), groups_, asked_accel_, 0));
    }
    built_at_rest_ = rest;
    {
        const vk::Stream::Scope scope(stream(), "pose");
        AG_CHECK(footage_->pose(stream(), time));
        footage_->place(stream(), time, !at_rest(time));
        stream().barrier();
    }
    const vk::Stream::Scope scope(stream(), "build");
    const mesh::gpu::DeviceSurfaces& surfaces = footage_->surfaces();
    std::vector<mat4> transforms;
    for (const uint32_t part : part_of_group_)
        transforms.push_back(surfaces.part_transforms()[part]);
    AG_CHECK(
        structure_->update(stream(), {surfaces.corners(), surfaces.triangle_count()}, transforms));
    stream().barrier();
    return {};
}

WavefrontFrame GpuFrameRenderer::frame_of(double time, const View& view) const {
    WavefrontFrame frame;
    frame.scene = footage_->scene();
    frame.structure = structure_->address();
    shared::FrameSettings& settings = frame.settings;
    settings.view = view.shared_view();
    settings.samples = static_cast<uint32_t>(options_.samples);
    settings.seed = seed_;
    settings.reflections = static_cast<uint32_t>(options_.reflections);
    settings.highlight =
        options_.shading == Shading::phong ? shared::kHighlightPhong : shared::kHighlightGgx;
    settings.stored = shared::kStoredNothing;
    if (lit_) settings.stored = at_rest(time) ? shared::kStoredAll : shared::kStoredResting;
    const bool lights_matter = settings.stored != shared::kStoredAll || settings.reflections > 0;
    frame.light_count = lights_matter ? footage_->light_count() : 0;
    frame.sky = !lit_ && footage_->tables().has_sky();
    frame.emitters = !lit_ && footage_->tables().has_emitters();
    return frame;
}

Result<DrawnFrame> GpuFrameRenderer::draw_frame(double time, const View& view,
                                                const Monitor& monitor) {
    AG_CHECK(move(time));
    AG_CHECK(wavefront_->draw(stream(), frame_of(time, view), monitor));
    DrawnFrame frame;
    frame.luminance = Image(view.width, view.height);
    AG_CHECK(stream().download_bytes(wavefront_->image(), 0,
                                     std::as_writable_bytes(std::span(frame.luminance.pixels))));
    AG_TRY(const auto counts, stream().download<shared::RayCounts>(wavefront_->counts(), 1));
    frame.rays = {whole(counts[0].camera), whole(counts[0].mirror), whole(counts[0].shadow)};
    return frame;
}

}  // namespace
}  // namespace render::gpu

Result<std::unique_ptr<FrameRenderer>> make_gpu_frame_renderer(const Gpu& gpu,
                                                               const Footage& footage, Accel accel,
                                                               const Monitor& monitor) {
    return render::gpu::make_prepared<render::gpu::GpuFrameRenderer>(gpu, footage, accel, monitor);
}

}  // namespace aglow
