// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"

#include "aglow/accel/gpu/trace_scene.h"
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/render/cpu/draw.h"
#include "aglow/render/gpu/device_tables.h"
#include "aglow/render/gpu/motion_groups.h"
#include "aglow/render/gpu/pass_times.h"
#include "aglow/render/gpu/wavefront.h"
#include "aglow/render/tables/resting_light.h"
#include "aglow/vk/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>

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

class GpuFrameRenderer : public FrameRenderer {
public:
    GpuFrameRenderer(Gpu gpu, vk::Stream stream, const Footage& footage)
        : gpu_(std::move(gpu)),
          stream_(std::move(stream)),
          scene_(footage.scene),
          lit_(footage.lit),
          options_(footage.options) {}

    Status prepare(Accel accel, const Monitor& monitor);
    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) override;
    std::string device() const override { return gpu_->info().name; }
    std::string accel() const override { return structure_names(structure_->kinds()); }

private:
    Status make_tables(const MotionGroups& grouped, const EmitterTable& emitters,
                       const Monitor& monitor);
    Result<DrawnFrame> draw_frame(double time, const View& view, const Monitor& monitor);
    Status move(double time);
    void place(double time);
    WavefrontFrame frame_of(double time, const View& view) const;
    bool at_rest(double time) const { return time < 0 || !has_resting_; }

    Gpu gpu_;
    vk::Stream stream_;
    const Scene& scene_;
    const Lit* lit_;
    RaysOptions options_;
    bool has_resting_ = false;  // baked light without what follows motion is known
    uint32_t light_count_ = 0;
    uint32_t seed_ = 0;
    std::vector<accel::gpu::Group> groups_;
    std::vector<uint32_t> part_of_group_;
    Accel asked_accel_ = Accel::automatic;
    std::optional<bool> built_at_rest_;
    std::optional<mesh::gpu::DeviceSurfaces> surfaces_;
    std::optional<DeviceTables> tables_;
    std::optional<accel::gpu::TraceScene> structure_;
    std::optional<Wavefront> wavefront_;
    vk::Buffer lights_, photometry_, device_scene_;
    std::optional<Error> failure_;  // after which nothing is drawn
};

Status GpuFrameRenderer::make_tables(const MotionGroups& grouped, const EmitterTable& emitters,
                                     const Monitor& monitor) {
    const LightTable lights = light_table(scene_, -1);
    light_count_ = static_cast<uint32_t>(lights.lights.size());
    Image resting;
    if (lit_ && has_motion(scene_) && light_count_ > 0) {
        AG_TRY(resting, resting_light(scene_, *lit_, monitor));
        has_resting_ = true;
    }
    AG_TRY(tables_, DeviceTables::create(stream_, {.scene = scene_,
                                                   .surfaces = grouped.surfaces,
                                                   .source_of = grouped.source_of,
                                                   .stored = lit_ ? &lit_->irradiance : nullptr,
                                                   .resting = has_resting_ ? &resting : nullptr,
                                                   .emitters = emitters,
                                                   .sky = lit_ ? SkyTable{} : sky_table(scene_)}));
    AG_TRY(lights_,
           gpu_->make_buffer(lights.lights.size() * sizeof(shared::PunctualLight), "lights"));
    AG_TRY(photometry_, vk::make_buffer_of(stream_, std::span(lights.photometry), "photometry"));
    AG_TRY(device_scene_, gpu_->make_buffer(sizeof(shared::DeviceScene), "scene"));
    return stream_.finish();
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
    AG_CHECK(make_tables(grouped, emitters, monitor));
    AG_TRY(surfaces_, mesh::gpu::DeviceSurfaces::create(stream_, scene_, grouped.surfaces));
    part_of_group_ = grouped.part_of;
    groups_ = grouped.groups;
    asked_accel_ = accel;
    AG_TRY(structure_, accel::gpu::TraceScene::create(gpu_, groups_, asked_accel_, 0));
    AG_TRY(wavefront_, Wavefront::create(stream_,
                                         {.kinds = structure_->kinds(),
                                          .alpha = tables_->has_alpha(),
                                          .textured = tables_->has_textures()},
                                         filter_offsets(options_)));
    return stream_.finish();
}

/// Brings surfaces and structure to `time`. What stands still at all times may stand elsewhere in
/// the rest pose.
Status GpuFrameRenderer::move(double time) {
    const bool rest = time < 0;
    if (built_at_rest_.value_or(rest) != rest) {
        AG_TRY(structure_, accel::gpu::TraceScene::create(gpu_, groups_, asked_accel_, 0));
    }
    built_at_rest_ = rest;
    {
        const vk::Stream::Scope scope(stream_, "pose");
        AG_CHECK(surfaces_->pose(stream_, time));
        stream_.barrier();
    }
    const vk::Stream::Scope scope(stream_, "build");
    std::vector<mat4> transforms;
    for (const uint32_t part : part_of_group_)
        transforms.push_back(surfaces_->part_transforms()[part]);
    AG_CHECK(structure_->update(stream_, {surfaces_->corners(), surfaces_->triangle_count()},
                                transforms));
    stream_.barrier();
    return {};
}

/// Tells shaders where all is at `time`.
void GpuFrameRenderer::place(double time) {
    const vk::Stream::Scope scope(stream_, "pose");
    const LightTable lights = light_table(scene_, time);
    shared::DeviceScene scene = tables_->scene(!at_rest(time));
    scene.corners = surfaces_->corners();
    scene.normals = surfaces_->normals();
    scene.triangles = surfaces_->indices();
    scene.lights = lights_.address();
    scene.photometry = photometry_.address();
    scene.light_count = light_count_;
    stream_.upload(std::span<const shared::PunctualLight>(lights.lights), lights_);
    stream_.upload(std::span<const shared::DeviceScene>(&scene, 1), device_scene_);
    stream_.barrier();
}

WavefrontFrame GpuFrameRenderer::frame_of(double time, const View& view) const {
    WavefrontFrame frame;
    frame.scene = device_scene_.address();
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
    frame.light_count = lights_matter ? light_count_ : 0;
    frame.sky = !lit_ && tables_->has_sky();
    frame.emitters = !lit_ && tables_->has_emitters();
    return frame;
}

Result<DrawnFrame> GpuFrameRenderer::draw_frame(double time, const View& view,
                                                const Monitor& monitor) {
    const auto start = std::chrono::steady_clock::now();
    AG_CHECK(move(time));
    place(time);
    AG_CHECK(wavefront_->draw(stream_, frame_of(time, view), monitor));
    DrawnFrame frame;
    frame.luminance = Image(view.width, view.height);
    AG_CHECK(stream_.download_bytes(wavefront_->image(), 0,
                                    std::as_writable_bytes(std::span(frame.luminance.pixels))));
    AG_TRY(const auto counts, stream_.download<shared::RayCounts>(wavefront_->counts(), 1));
    frame.rays = {whole(counts[0].camera), whole(counts[0].mirror), whole(counts[0].shadow)};
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    frame.seconds = pass_times(stream_.take_timings(), wall.count());
    return frame;
}

Result<DrawnFrame> GpuFrameRenderer::draw(double time, const View& view,
                                          const Monitor& monitor) try {
    if (failure_) return tl::unexpected<Error>(*failure_);
    if (view.width < 1 || view.height < 1)
        return fail(Errc::bad_argument,
                    fmt::format("an image of {}x{} pixels is empty", view.width, view.height));
    Result<DrawnFrame> frame = draw_frame(time, view, monitor);
    if (!frame && frame.error().code != Errc::cancelled) failure_ = frame.error();
    return frame;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", view.width, view.height));
}

}  // namespace
}  // namespace render::gpu

Result<std::unique_ptr<FrameRenderer>> make_gpu_frame_renderer(const Gpu& gpu,
                                                               const Footage& footage, Accel accel,
                                                               const Monitor& monitor) try {
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    auto renderer =
        std::make_unique<render::gpu::GpuFrameRenderer>(gpu, std::move(stream), footage);
    AG_CHECK(renderer->prepare(accel, monitor));
    return renderer;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to prepare the scene");
}

}  // namespace aglow
