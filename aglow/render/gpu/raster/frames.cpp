// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/raster.h"

#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/render/gpu/device_tables.h"
#include "aglow/render/gpu/pass_times.h"
#include "aglow/render/gpu/raster/half.h"
#include "aglow/render/gpu/raster/light.h"
#include "aglow/render/gpu/raster/order.comp.h"
#include "aglow/render/gpu/raster/part_list.h"
#include "aglow/render/gpu/raster/sky.frag.h"
#include "aglow/render/gpu/raster/sky.vert.h"
#include "aglow/render/gpu/raster/surface.frag.h"
#include "aglow/render/gpu/raster/vertex_source.h"
#include "aglow/vk/device.h"
#include "aglow/vk/radix_sort.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

namespace aglow {
namespace render::gpu {
namespace {

constexpr size_t kMostEmitters = 32;  // whose form factors are worked out at every pixel
constexpr float kMostHalf = 65504;    // the largest number of 16 bits

/// Push constants of order.comp.
struct OrderArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t scene = 0, frame = 0;
    uint64_t faces = 0, keys = 0, sortable = 0;
};

/// Blended faces and what sorts them.
struct BlendOrder {
    vk::Kernel order;
    vk::RadixSort sort;
    vk::Buffer faces, keys, sortable;
    uint32_t count = 0;

    static Result<BlendOrder> create(vk::Stream& stream, const std::vector<uint32_t>& faces);
    /// Result  address of the faces from the farthest to the nearest.
    uint64_t record(vk::Stream& stream, uint64_t scene, uint64_t frame) const;
};

Result<BlendOrder> BlendOrder::create(vk::Stream& stream, const std::vector<uint32_t>& faces) {
    const Gpu& gpu = stream.gpu();
    AG_TRY(vk::Kernel order, vk::Kernel::create(gpu, "order", shaders::order_comp));
    AG_TRY(vk::RadixSort sort, vk::RadixSort::create(gpu));
    AG_CHECK(sort.reserve(faces.size()));
    AG_TRY(vk::Buffer list,
           vk::make_buffer_of(stream, std::span<const uint32_t>(faces), "blended triangles"));
    AG_TRY(vk::Buffer keys, stream.make_buffer(4 * faces.size(), "depths of blended triangles"));
    AG_TRY(vk::Buffer sortable, stream.make_buffer(4 * faces.size(), "order of blended triangles"));
    return BlendOrder{std::move(order), std::move(sort),     std::move(list),
                      std::move(keys),  std::move(sortable), static_cast<uint32_t>(faces.size())};
}

uint64_t BlendOrder::record(vk::Stream& stream, uint64_t scene, uint64_t frame) const {
    stream.run(
        order,
        OrderArgs{0, count, scene, frame, faces.address(), keys.address(), sortable.address()},
        vk::group_count(count, 64));
    stream.barrier();
    return sort.record(stream, keys.address(), sortable.address(), count, 32).values;
}

/// Pipelines of the layers that a scene has.
struct Pipelines {
    std::array<std::optional<vk::GraphicsPipeline>, kSolidLayers> solid;
    std::optional<vk::GraphicsPipeline> blended, sky;
};

class RasterRenderer : public FrameRenderer {
public:
    RasterRenderer(Gpu gpu, vk::Stream stream, const Footage& footage)
        : gpu_(std::move(gpu)),
          stream_(std::move(stream)),
          scene_(footage.scene),
          lit_(footage.lit) {}

    Status prepare(const RasterOptions& options);
    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) override;
    std::string device() const override { return gpu_->info().name; }
    std::string accel() const override { return "none"; }

private:
    Status make_tables(const Surfaces& rest);
    Status make_pipelines();
    Result<vk::GraphicsPipeline> surface_pipeline(Layer layer) const;
    Status reserve_target(const View& view);
    Status move(double time);
    void place(double time, const View& view, const Projection& projection);
    void draw_layers(const Projection& projection, uint64_t order);
    Result<DrawnFrame> draw_frame(double time, const View& view, const Monitor& monitor);
    Result<Image> read_image();

    Gpu gpu_;
    vk::Stream stream_;
    const Scene& scene_;
    const Lit* lit_;
    std::optional<mesh::gpu::DeviceSurfaces> surfaces_;
    std::optional<DeviceTables> tables_;
    std::optional<PartList> parts_;
    std::unique_ptr<VertexSource> source_;
    std::optional<BlendOrder> blend_order_;
    Pipelines pipelines_;
    vk::TargetFormat format_;
    std::optional<vk::RenderTarget> target_;
    vk::Buffer pixels_;
    vk::Buffer lights_, photometry_, emitters_, device_scene_, frame_;
    uint32_t light_count_ = 0, emitter_count_ = 0;
    std::array<vec3, shared::kSkyTerms> sky_terms_{};
    std::optional<Error> failure_;  // after which nothing is drawn
};

Status RasterRenderer::make_tables(const Surfaces& rest) {
    const LightTable lights = light_table(scene_, -1);
    light_count_ = static_cast<uint32_t>(lights.lights.size());
    std::vector<shared::RasterEmitter> emitters;
    if (!lit_) {
        emitters = raster_emitters(scene_, rest, kMostEmitters);
        sky_terms_ = sky_terms(scene_);
    }
    emitter_count_ = static_cast<uint32_t>(emitters.size());
    AG_TRY(tables_, DeviceTables::create(stream_, {.scene = scene_,
                                                   .surfaces = rest,
                                                   .source_of = {},
                                                   .stored = lit_ ? &lit_->irradiance : nullptr,
                                                   .resting = nullptr,
                                                   .emitters = EmitterTable{},
                                                   .sky = SkyTable{}}));
    AG_TRY(lights_,
           gpu_->make_buffer(lights.lights.size() * sizeof(shared::PunctualLight), "lights"));
    AG_TRY(photometry_, vk::make_buffer_of(stream_, std::span(lights.photometry), "photometry"));
    AG_TRY(emitters_, vk::make_buffer_of(stream_, std::span<const shared::RasterEmitter>(emitters),
                                         "emissive triangles"));
    AG_TRY(device_scene_, gpu_->make_buffer(sizeof(shared::DeviceScene), "scene"));
    AG_TRY(frame_, gpu_->make_buffer(sizeof(shared::RasterFrame), "frame"));
    return stream_.finish();
}

Result<vk::GraphicsPipeline> RasterRenderer::surface_pipeline(Layer layer) const {
    const bool cut = layer == Layer::cut || layer == Layer::cut_both_sides;
    const bool one_sided = layer == Layer::opaque || layer == Layer::cut;
    const std::array<uint32_t, 2> constants{tables_->has_textures() ? 1u : 0u,
                                            cut || layer == Layer::blended ? 1u : 0u};
    vk::GraphicsShaders shaders;
    shaders.vertex = source_->vertex_shader();
    shaders.fragment = shaders::surface_frag;
    vk::GraphicsState state;
    state.target = format_;
    state.cull = one_sided ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    state.sample_shading = cut;  // masks are cut as fine as edges
    state.blend = layer == Layer::blended ? vk::Blend::over : vk::Blend::none;
    state.write_depth = layer != Layer::blended;
    state.constants = constants;
    constexpr std::array kNames{"opaque", "opaque, both sides", "cut", "cut, both sides",
                                "blended"};
    return vk::GraphicsPipeline::create(gpu_, kNames[static_cast<size_t>(layer)], shaders, state);
}

Status RasterRenderer::make_pipelines() {
    for (size_t i = 0; i < kSolidLayers; ++i) {
        const Layer layer = static_cast<Layer>(i);
        if (!parts_->has(layer)) continue;
        AG_TRY(pipelines_.solid[i], surface_pipeline(layer));
    }
    if (parts_->has(Layer::blended)) {
        AG_TRY(pipelines_.blended, surface_pipeline(Layer::blended));
        AG_TRY(blend_order_, BlendOrder::create(stream_, parts_->blended()));
    }
    if (!scene_.sky) return {};
    vk::GraphicsShaders shaders;
    shaders.vertex = shaders::sky_vert;
    shaders.fragment = shaders::sky_frag;
    vk::GraphicsState state;
    state.target = format_;
    state.nearer = VK_COMPARE_OP_GREATER_OR_EQUAL;  // its depth is that of what is cleared
    state.write_depth = false;
    AG_TRY(pipelines_.sky, vk::GraphicsPipeline::create(gpu_, "sky", shaders, state));
    return {};
}

Status RasterRenderer::prepare(const RasterOptions& options) {
    if (options.samples < 1)
        return fail(Errc::bad_argument, fmt::format("{} samples of a pixel", options.samples));
    const Refinement& refinement = options.refinement;
    if (refinement.level < 0 || refinement.level > kMostRefinement)
        return fail(Errc::bad_argument, fmt::format("refinement level {} is not in 0..{}",
                                                    refinement.level, kMostRefinement));
    AG_CHECK(gpu_->check_drawing());
    uint32_t samples = 1;
    while (samples < static_cast<uint32_t>(std::min(options.samples, 64))) samples *= 2;
    format_ = vk::hdr_format(*gpu_, samples);
    const Surfaces rest = pose(scene_, -1, lit_ ? &lit_->atlas : nullptr);
    AG_CHECK(make_tables(rest));
    AG_TRY(surfaces_, mesh::gpu::DeviceSurfaces::create(stream_, scene_, rest));
    parts_.emplace(scene_, rest);
    if (refinement.kind == Refinement::Kind::none) {
        AG_TRY(source_, make_plain_source(stream_, *surfaces_));
    } else {
        AG_TRY(source_, make_pattern_source(stream_, *surfaces_, scene_, rest, refinement));
    }
    AG_CHECK(make_pipelines());
    return stream_.finish();
}

Status RasterRenderer::reserve_target(const View& view) {
    const auto width = static_cast<uint32_t>(view.width);
    const auto height = static_cast<uint32_t>(view.height);
    if (target_ && target_->width() == width && target_->height() == height) return {};
    target_.reset();
    pixels_ = {};
    AG_TRY(target_, vk::RenderTarget::create(gpu_, width, height, format_, "picture"));
    AG_TRY(pixels_, gpu_->make_buffer(target_->row_bytes() * height, "picture"));
    return {};
}

Status RasterRenderer::move(double time) {
    const vk::Stream::Scope scope(stream_, "pose");
    AG_CHECK(surfaces_->pose(stream_, time));
    stream_.barrier();
    AG_CHECK(source_->update(stream_));
    stream_.barrier();
    return {};
}

/// Tells shaders where all is at `time`.
void RasterRenderer::place(double time, const View& view, const Projection& projection) {
    const vk::Stream::Scope scope(stream_, "pose");
    const LightTable lights = light_table(scene_, time);
    shared::DeviceScene scene = tables_->scene(false);
    scene.corners = surfaces_->corners();
    scene.normals = surfaces_->normals();
    scene.triangles = surfaces_->indices();
    scene.lights = lights_.address();
    scene.photometry = photometry_.address();
    scene.light_count = light_count_;
    shared::RasterFrame frame{};
    frame.view = view.shared_view();
    frame.clip_x = projection.rows[0];
    frame.clip_y = projection.rows[1];
    frame.clip_z = projection.rows[2];
    frame.clip_w = projection.rows[3];
    std::copy(sky_terms_.begin(), sky_terms_.end(), frame.sky);
    frame.most_luminance =
        format_.color == VK_FORMAT_R16G16B16A16_SFLOAT ? kMostHalf : shared::kFarAway;
    frame.baked = lit_ ? 1 : 0;
    frame.emitter_count = emitter_count_;
    frame.emitters = emitters_.address();
    stream_.upload(std::span<const shared::PunctualLight>(lights.lights), lights_);
    stream_.upload(std::span<const shared::DeviceScene>(&scene, 1), device_scene_);
    stream_.upload(std::span<const shared::RasterFrame>(&frame, 1), frame_);
    stream_.barrier();
}

void RasterRenderer::draw_layers(const Projection& projection, uint64_t order) {
    const vk::Stream::Scope scope(stream_, "draw");
    shared::RasterArgs args{device_scene_.address(), frame_.address(), source_->geometry(), 0, 0};
    stream_.clear(*target_, {0, 0, 0, 1});
    const auto layers =
        parts_->visible(surfaces_->part_transforms(), projection, source_->overhang());
    for (size_t i = 0; i < layers.size(); ++i)
        for (const FaceRange& range : layers[i])
            stream_.draw(*pipelines_.solid[i], *target_, args,
                         source_->draw(range.first, range.count));
    if (pipelines_.sky) stream_.draw(*pipelines_.sky, *target_, args, {0, 3});
    if (!pipelines_.blended) return;
    args.order = order;
    args.ordered = 1;
    stream_.draw(*pipelines_.blended, *target_, args, source_->draw(0, blend_order_->count));
}

Result<Image> RasterRenderer::read_image() {
    {
        const vk::Stream::Scope scope(stream_, "read");
        stream_.read(*target_, pixels_);
    }
    const size_t count = size_t{target_->width()} * target_->height();
    Image image(static_cast<int>(target_->width()), static_cast<int>(target_->height()));
    if (format_.color == VK_FORMAT_R16G16B16A16_SFLOAT) {
        AG_TRY(const auto halves, (stream_.download<std::array<uint16_t, 4>>(pixels_, count)));
        for (size_t i = 0; i < count; ++i)
            image.pixels[i] = {half_to_float(halves[i][0]), half_to_float(halves[i][1]),
                               half_to_float(halves[i][2])};
        return image;
    }
    AG_TRY(const auto colors, stream_.download<vec4>(pixels_, count));
    for (size_t i = 0; i < count; ++i) image.pixels[i] = {colors[i].x, colors[i].y, colors[i].z};
    return image;
}

Result<DrawnFrame> RasterRenderer::draw_frame(double time, const View& view,
                                              const Monitor& monitor) {
    const auto start = std::chrono::steady_clock::now();
    AG_CHECK(reserve_target(view));
    AG_CHECK(move(time));
    const Projection projection = projection_of(view, parts_->bounds(surfaces_->part_transforms()));
    place(time, view, projection);
    uint64_t order = 0;
    if (blend_order_) {
        const vk::Stream::Scope scope(stream_, "order");
        order = blend_order_->record(stream_, device_scene_.address(), frame_.address());
        stream_.barrier();
    }
    draw_layers(projection, order);
    DrawnFrame frame;
    AG_TRY(frame.luminance, read_image());
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    frame.seconds = pass_times(stream_.take_timings(), wall.count());
    if (monitor.cancelled()) return fail(Errc::cancelled, "rendering was interrupted");
    return frame;
}

Result<DrawnFrame> RasterRenderer::draw(double time, const View& view, const Monitor& monitor) try {
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

Result<std::unique_ptr<FrameRenderer>> make_raster_frame_renderer(
    const Gpu& gpu, const Footage& footage, const RasterOptions& options) try {
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    auto renderer = std::make_unique<render::gpu::RasterRenderer>(gpu, std::move(stream), footage);
    AG_CHECK(renderer->prepare(options));
    return renderer;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to prepare the scene");
}

}  // namespace aglow
