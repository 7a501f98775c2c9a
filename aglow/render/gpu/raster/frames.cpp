// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/raster.h"

#include "aglow/render/gpu/device_footage.h"
#include "aglow/render/gpu/device_frames.h"
#include "aglow/render/gpu/raster/blend_order.h"
#include "aglow/render/gpu/raster/half.h"
#include "aglow/render/gpu/raster/light.h"
#include "aglow/render/gpu/raster/part_list.h"
#include "aglow/render/gpu/raster/sky.frag.h"
#include "aglow/render/gpu/raster/sky.vert.h"
#include "aglow/render/gpu/raster/surface.frag.h"
#include "aglow/render/gpu/raster/vertex_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace aglow {
namespace render::gpu {
namespace {

constexpr size_t kMostEmitters = 32;  // whose form factors are worked out at every pixel
constexpr float kMostHalf = 65504;    // the largest number of 16 bits

using Layers = std::array<std::vector<FaceRange>, kSolidLayers>;

bool is_subdivision(Refinement::Kind kind) {
    return kind == Refinement::Kind::loop || kind == Refinement::Kind::catmull_clark;
}

/// Pipelines of the layers that a scene has.
struct Pipelines {
    std::array<std::optional<vk::GraphicsPipeline>, kSolidLayers> solid;
    std::optional<vk::GraphicsPipeline> blended, sky;
};

class RasterRenderer : public DeviceFrameRenderer {
public:
    RasterRenderer(vk::Stream stream, const Footage& footage)
        : DeviceFrameRenderer(std::move(stream)), scene_(footage.scene), lit_(footage.lit) {}

    Status prepare(const RasterOptions& options);
    std::string accel() const override { return "none"; }

private:
    Status make_footage(const Surfaces& rest);
    Status make_source(const Surfaces& rest, const RasterOptions& options);
    Status make_pipelines();
    Result<vk::GraphicsPipeline> surface_pipeline(Layer layer) const;
    Status reserve_target(const View& view);
    Status move(double time);
    void place(const View& view, const Projection& projection);
    void draw_layers(const Layers& layers, uint64_t order, DrawnFrame& frame);
    shared::RasterArgs raster_args() const;
    void draw_faces(Layer layer, std::span<const FaceRange> faces, uint64_t order,
                    DrawnFrame& frame);
    Result<DrawnFrame> draw_frame(double time, const View& view, const Monitor& monitor) override;
    Result<Image> read_image();

    const Scene& scene_;
    const Lit* lit_;
    std::optional<DeviceFootage> footage_;
    std::optional<PartList> parts_;
    std::unique_ptr<VertexSource> source_;
    std::optional<BlendOrder> blend_order_;
    Pipelines pipelines_;
    vk::TargetFormat format_;
    std::optional<vk::RenderTarget> target_;
    vk::Buffer pixels_;
    vk::Buffer emitters_, frame_;
    uint32_t emitter_count_ = 0;
    std::array<vec3, shared::kSkyTerms> sky_terms_{};
};

Status RasterRenderer::make_footage(const Surfaces& rest) {
    std::vector<shared::RasterEmitter> emitters;
    if (!lit_) {
        emitters = raster_emitters(scene_, rest, kMostEmitters);
        sky_terms_ = sky_terms(scene_);
    }
    emitter_count_ = static_cast<uint32_t>(emitters.size());
    AG_TRY(emitters_, vk::make_buffer_of(stream(), std::span<const shared::RasterEmitter>(emitters),
                                         "emissive triangles"));
    AG_TRY(frame_, gpu()->make_buffer(sizeof(shared::RasterFrame), "frame"));
    AG_TRY(footage_, DeviceFootage::create(stream(), {.scene = scene_,
                                                      .surfaces = rest,
                                                      .source_of = {},
                                                      .stored = lit_ ? &lit_->irradiance : nullptr,
                                                      .resting = nullptr,
                                                      .emitters = EmitterTable{},
                                                      .sky = SkyTable{}}));
    return {};
}

Result<vk::GraphicsPipeline> RasterRenderer::surface_pipeline(Layer layer) const {
    const bool cut = layer == Layer::cut || layer == Layer::cut_both_sides;
    const bool one_sided = layer == Layer::opaque || layer == Layer::cut;
    const std::array<uint32_t, 3> constants{footage_->tables().has_textures() ? 1u : 0u,
                                            cut || layer == Layer::blended ? 1u : 0u,
                                            source_->displacement()};
    vk::GraphicsShaders shaders = source_->shaders();
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
    return vk::GraphicsPipeline::create(gpu(), kNames[static_cast<size_t>(layer)], shaders, state);
}

Status RasterRenderer::make_pipelines() {
    for (size_t i = 0; i < kSolidLayers; ++i) {
        const Layer layer = static_cast<Layer>(i);
        if (!parts_->has(layer)) continue;
        AG_TRY(pipelines_.solid[i], surface_pipeline(layer));
    }
    if (parts_->has(Layer::blended)) {
        AG_TRY(pipelines_.blended, surface_pipeline(Layer::blended));
        AG_TRY(blend_order_, BlendOrder::create(stream(), parts_->blended()));
    }
    if (!scene_.sky) return {};
    vk::GraphicsShaders shaders;
    shaders.vertex = shaders::sky_vert;
    shaders.fragment = shaders::sky_frag;
    vk::GraphicsState state;
    state.target = format_;
    state.nearer = VK_COMPARE_OP_GREATER_OR_EQUAL;  // its depth is that of what is cleared
    state.write_depth = false;
    AG_TRY(pipelines_.sky, vk::GraphicsPipeline::create(gpu(), "sky", shaders, state));
    return {};
}

Status RasterRenderer::make_source(const Surfaces& rest, const RasterOptions& options) {
    const mesh::gpu::DeviceSurfaces& surfaces = footage_->surfaces();
    const Refinement& refinement = options.refinement;
    if (refinement.kind == Refinement::Kind::none) {
        AG_TRY(source_, make_plain_source(stream(), surfaces));
    } else if (refinement.kind == Refinement::Kind::automatic) {
        AG_TRY(source_, make_adaptive_source(stream(), surfaces, scene_, rest, options));
    } else if (is_subdivision(refinement.kind)) {
        AG_TRY(source_, make_subdivision_source(stream(), surfaces, scene_, rest, refinement));
    } else {
        AG_TRY(source_, make_pattern_source(stream(), surfaces, scene_, rest, options));
    }
    return {};
}

Status RasterRenderer::prepare(const RasterOptions& options) {
    if (options.samples < 1)
        return fail(Errc::bad_argument, fmt::format("{} samples of a pixel", options.samples));
    const Refinement& refinement = options.refinement;
    const int least = refinement.kind == Refinement::Kind::catmull_clark ? 1 : 0;
    if (refinement.level < least || refinement.level > kMostRefinement)
        return fail(Errc::bad_argument, fmt::format("refinement level {} is not in {}..{}",
                                                    refinement.level, least, kMostRefinement));
    if (!(refinement.tolerance >= kFinestTolerance && refinement.tolerance <= kCoarsestTolerance))
        return fail(Errc::bad_argument,
                    fmt::format("a tolerance of {} pixels is not in {}..{}", refinement.tolerance,
                                kFinestTolerance, kCoarsestTolerance));
    AG_CHECK(gpu()->check_drawing());
    uint32_t samples = 1;
    while (samples < static_cast<uint32_t>(std::min(options.samples, 64))) samples *= 2;
    format_ = vk::hdr_format(*gpu(), samples);
    const Surfaces rest = pose(scene_, -1, lit_ ? &lit_->atlas : nullptr);
    AG_CHECK(make_footage(rest));
    parts_.emplace(scene_, rest, is_subdivision(refinement.kind) ? Reach::mesh : Reach::part);
    AG_CHECK(make_source(rest, options));
    AG_CHECK(make_pipelines());
    return stream().finish();
}

Status RasterRenderer::reserve_target(const View& view) {
    const auto width = static_cast<uint32_t>(view.width);
    const auto height = static_cast<uint32_t>(view.height);
    if (target_ && target_->width() == width && target_->height() == height) return {};
    target_.reset();
    pixels_ = {};
    AG_TRY(target_, vk::RenderTarget::create(gpu(), width, height, format_, "picture"));
    AG_TRY(pixels_, gpu()->make_buffer(target_->row_bytes() * height, "picture"));
    return {};
}

Status RasterRenderer::move(double time) {
    const vk::Stream::Scope scope(stream(), "pose");
    AG_CHECK(footage_->pose(stream(), time));
    footage_->place(stream(), time, false);
    return {};
}

/// Tells shaders what the frame is lit and seen by.
void RasterRenderer::place(const View& view, const Projection& projection) {
    const vk::Stream::Scope scope(stream(), "pose");
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
    stream().upload(std::span<const shared::RasterFrame>(&frame, 1), frame_);
    stream().barrier();
}

shared::RasterArgs RasterRenderer::raster_args() const {
    shared::RasterArgs args{};
    args.scene = footage_->scene();
    args.frame = frame_.address();
    return args;
}

void RasterRenderer::draw_faces(Layer layer, std::span<const FaceRange> faces, uint64_t order,
                                DrawnFrame& frame) {
    const vk::GraphicsPipeline& pipeline = layer == Layer::blended
                                               ? *pipelines_.blended
                                               : *pipelines_.solid[static_cast<size_t>(layer)];
    SurfacePass pass{pipeline, *target_, raster_args()};
    pass.args.geometry = source_->geometry();
    pass.args.order = order;
    pass.args.ordered = order != 0 ? 1u : 0u;
    for (const FaceDraw& draw : source_->draws(layer, faces)) source_->draw(stream(), pass, draw);
    frame.triangles += source_->triangles(layer, faces);
}

void RasterRenderer::draw_layers(const Layers& layers, uint64_t order, DrawnFrame& frame) {
    const vk::Stream::Scope scope(stream(), "draw");
    stream().clear(*target_, {0, 0, 0, 1});
    for (size_t i = 0; i < layers.size(); ++i)
        if (!layers[i].empty())
            draw_faces(static_cast<Layer>(i), layers[i], source_->order(), frame);
    if (pipelines_.sky) stream().draw(*pipelines_.sky, *target_, raster_args(), {0, 3});
    if (!pipelines_.blended) return;
    const FaceRange blended{0, blend_order_->count()};
    draw_faces(Layer::blended, {&blended, 1}, order, frame);
}

Result<Image> RasterRenderer::read_image() {
    {
        const vk::Stream::Scope scope(stream(), "read");
        stream().read(*target_, pixels_);
    }
    const size_t count = size_t{target_->width()} * target_->height();
    Image image(static_cast<int>(target_->width()), static_cast<int>(target_->height()));
    if (format_.color == VK_FORMAT_R16G16B16A16_SFLOAT) {
        AG_TRY(const auto halves, (stream().download<std::array<uint16_t, 4>>(pixels_, count)));
        for (size_t i = 0; i < count; ++i)
            image.pixels[i] = {half_to_float(halves[i][0]), half_to_float(halves[i][1]),
                               half_to_float(halves[i][2])};
        return image;
    }
    AG_TRY(const auto colors, stream().download<vec4>(pixels_, count));
    for (size_t i = 0; i < count; ++i) image.pixels[i] = {colors[i].x, colors[i].y, colors[i].z};
    return image;
}

Result<DrawnFrame> RasterRenderer::draw_frame(double time, const View& view,
                                              const Monitor& monitor) {
    AG_CHECK(reserve_target(view));
    AG_CHECK(move(time));
    const std::span<const mat4> transforms = footage_->surfaces().part_transforms();
    const Projection projection = projection_of(view, parts_->bounds(transforms));
    const Layers layers = parts_->visible(transforms, projection, source_->overhang());
    AG_CHECK(source_->update(stream(), {view, projection, layers, parts_->blended()}));
    place(view, projection);
    uint64_t order = 0;
    if (blend_order_) {
        const vk::Stream::Scope scope(stream(), "order");
        order = blend_order_->record(stream(), footage_->scene(), frame_.address());
    }
    DrawnFrame frame;
    draw_layers(layers, order, frame);
    frame.tolerance = source_->tolerance();
    AG_TRY(frame.luminance, read_image());
    if (monitor.cancelled()) return fail(Errc::cancelled, "rendering was interrupted");
    return frame;
}

}  // namespace
}  // namespace render::gpu

Result<std::unique_ptr<FrameRenderer>> make_raster_frame_renderer(const Gpu& gpu,
                                                                  const Footage& footage,
                                                                  const RasterOptions& options) {
    return render::gpu::make_prepared<render::gpu::RasterRenderer>(gpu, footage, options);
}

}  // namespace aglow
