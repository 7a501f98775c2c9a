// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/wavefront.h"

#include "aglow/render/gpu/camera.comp.h"
#include "aglow/render/gpu/collect.comp.h"
#include "aglow/render/gpu/count.comp.h"
#include "aglow/render/gpu/emitter_rays.comp.h"
#include "aglow/render/gpu/finish.comp.h"
#include "aglow/render/gpu/light_rays.comp.h"
#include "aglow/render/gpu/resolve.comp.h"
#include "aglow/render/gpu/shade.comp.h"
#include "aglow/render/gpu/shadow.comp.h"
#include "aglow/render/gpu/sky_rays.comp.h"
#include "aglow/render/gpu/trace.comp.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <array>

namespace aglow::render::gpu {
namespace {

using shared::kShadowSlots;
using shared::kWavefrontGroupSize;
using shared::WavefrontArgs;

constexpr uint64_t kBlock = 64;  // pixels that are worked on together, see tile_pixel()
constexpr uint64_t kLeastPaths = 1u << 12;

uint64_t groups(uint64_t count) { return vk::group_count(count, kWavefrontGroupSize); }

/// Lays arrays out one after another.
class Layout {
public:
    template <class T>
    void add(uint64_t& offset, uint64_t count) {
        offset = bytes_;
        bytes_ = (bytes_ + count * sizeof(T) + 255) / 256 * 256;
    }
    uint64_t bytes() const { return bytes_; }

private:
    uint64_t bytes_ = 0;
};

/// Offsets of the arrays in their buffer, and its size.
std::pair<shared::Wavefront, uint64_t> lay_out(uint64_t paths) {
    shared::Wavefront w{};
    Layout layout;
    const uint64_t shadows = paths * kShadowSlots;
    layout.add<shared::WavefrontPath>(w.paths, paths);
    layout.add<shared::RayQuery>(w.rays, paths);
    layout.add<shared::RayHit>(w.hits, paths);
    layout.add<uint32_t>(w.alive, paths);
    layout.add<uint32_t>(w.queue, paths);
    layout.add<uint32_t>(w.queued, 1);
    layout.add<shared::WavefrontSurface>(w.surfaces, paths);
    layout.add<uint32_t>(w.lit, paths);
    layout.add<uint32_t>(w.lit_queue, paths);
    layout.add<uint32_t>(w.lit_queued, 1);
    layout.add<shared::WavefrontShadow>(w.shadows, shadows);
    layout.add<shared::RayQuery>(w.shadow_rays, shadows);
    layout.add<uint32_t>(w.shadow_alive, shadows);
    layout.add<uint32_t>(w.shadow_queue, shadows);
    layout.add<uint32_t>(w.shadow_queued, 1);
    layout.add<float>(w.visibility, shadows);
    return {w, layout.bytes()};
}

uint64_t tiled_pixels(const shared::CameraView& view) {
    return uint64_t{(view.width + 7) / 8} * ((view.height + 7) / 8) * kBlock;
}

}  // namespace

Result<Wavefront::Kernels> Wavefront::make_kernels(const Gpu& gpu, const SceneTraits& traits) {
    using vk::Kernel;
    const std::array<uint32_t, 1> shade{traits.textured ? 1u : 0u};
    const std::array<uint32_t, 3> trace{shade[0], traits.kinds, traits.alpha ? 1u : 0u};
    const std::array<uint32_t, 1> yes{1}, no{0};
    AG_TRY(Kernel camera_kernel, Kernel::create(gpu, "camera rays", shaders::camera_comp));
    AG_TRY(Kernel trace_kernel, Kernel::create(gpu, "nearest hits", shaders::trace_comp, trace));
    AG_TRY(Kernel shade_kernel, Kernel::create(gpu, "shade", shaders::shade_comp, shade));
    AG_TRY(Kernel light_kernel, Kernel::create(gpu, "rays to lights", shaders::light_rays_comp));
    AG_TRY(Kernel sky_kernel, Kernel::create(gpu, "rays to the sky", shaders::sky_rays_comp));
    AG_TRY(Kernel emitter_kernel,
           Kernel::create(gpu, "rays to emitters", shaders::emitter_rays_comp, shade));
    AG_TRY(Kernel shadow_kernel, Kernel::create(gpu, "shadow rays", shaders::shadow_comp, trace));
    AG_TRY(Kernel collect_kernel, Kernel::create(gpu, "collect", shaders::collect_comp, yes));
    AG_TRY(Kernel collect_area_kernel,
           Kernel::create(gpu, "collect from area lights", shaders::collect_comp, no));
    AG_TRY(Kernel finish_kernel, Kernel::create(gpu, "finish", shaders::finish_comp));
    AG_TRY(Kernel resolve_kernel, Kernel::create(gpu, "resolve", shaders::resolve_comp));
    AG_TRY(Kernel count_kernel, Kernel::create(gpu, "count rays", shaders::count_comp, no));
    AG_TRY(Kernel count_shadow_kernel,
           Kernel::create(gpu, "count shadow rays", shaders::count_comp, yes));
    return Kernels{.camera = std::move(camera_kernel),
                   .trace = std::move(trace_kernel),
                   .shade = std::move(shade_kernel),
                   .lights = std::move(light_kernel),
                   .sky = std::move(sky_kernel),
                   .emitters = std::move(emitter_kernel),
                   .shadow = std::move(shadow_kernel),
                   .collect_lights = std::move(collect_kernel),
                   .collect_area = std::move(collect_area_kernel),
                   .finish = std::move(finish_kernel),
                   .resolve = std::move(resolve_kernel),
                   .count = std::move(count_kernel),
                   .count_shadow = std::move(count_shadow_kernel)};
}

Result<Wavefront> Wavefront::create(vk::Stream& stream, const SceneTraits& traits,
                                    std::span<const vec2> offsets) {
    const Gpu& gpu = stream.gpu();
    AG_TRY(vk::Compact compact, vk::Compact::create(gpu));
    AG_TRY(Kernels kernels, make_kernels(gpu, traits));
    Wavefront result(std::move(compact), std::move(kernels));
    AG_TRY(result.offsets_, vk::make_buffer_of(stream, offsets, "pixel filter"));
    AG_TRY(result.settings_, gpu->make_buffer(sizeof(shared::FrameSettings), "frame settings"));
    AG_TRY(result.counts_, gpu->make_buffer(sizeof(shared::RayCounts), "ray counts"));
    AG_TRY(result.addresses_, gpu->make_buffer(sizeof(shared::Wavefront), "wavefront"));
    return result;
}

Status Wavefront::make_paths(vk::Stream& stream, uint64_t capacity) {
    const auto [offsets, bytes] = lay_out(capacity);
    paths_ = {};
    capacity_ = 0;
    AG_TRY(paths_, stream.gpu()->make_buffer(bytes, "paths in flight"));
    AG_CHECK(compact_.reserve(capacity * kShadowSlots));
    wavefront_ = offsets;
    for (uint64_t* address :
         {&wavefront_.paths, &wavefront_.rays, &wavefront_.hits, &wavefront_.alive,
          &wavefront_.queue, &wavefront_.queued, &wavefront_.surfaces, &wavefront_.lit,
          &wavefront_.lit_queue, &wavefront_.lit_queued, &wavefront_.shadows,
          &wavefront_.shadow_rays, &wavefront_.shadow_alive, &wavefront_.shadow_queue,
          &wavefront_.shadow_queued, &wavefront_.visibility})
        *address += paths_.address();
    stream.upload(std::span<const shared::Wavefront>(&wavefront_, 1), addresses_);
    capacity_ = capacity;
    return {};
}

/// Memory for the frame: where there is little, fewer paths go together.
Status Wavefront::prepare(vk::Stream& stream, const WavefrontFrame& frame) {
    const shared::CameraView& view = frame.settings.view;
    const uint64_t image_bytes = uint64_t{view.width} * view.height * sizeof(vec3);
    AG_CHECK(stream.gpu()->grow(image_, image_bytes, "image"));
    const uint64_t all = tiled_pixels(view) * frame.settings.samples;
    while (capacity_ < std::min(all, most_paths_)) {
        Status made = make_paths(stream, std::min(all, most_paths_));
        if (made) break;
        if (made.error().code != Errc::out_of_memory || most_paths_ <= kLeastPaths) return made;
        most_paths_ /= 2;
    }
    const vk::Stream::Scope scope(stream, "camera");
    shared::FrameSettings settings = frame.settings;
    settings.offsets = offsets_.address();
    settings.image = image_.address();
    settings.counts = counts_.address();
    stream.upload(std::span<const shared::FrameSettings>(&settings, 1), settings_);
    stream.fill(counts_, 0, 0, counts_.size());
    stream.barrier();
    return {};
}

Status Wavefront::draw(vk::Stream& stream, const WavefrontFrame& frame, const Monitor& monitor) {
    AG_CHECK(prepare(stream, frame));
    const uint64_t pixels = tiled_pixels(frame.settings.view);
    const uint64_t tile = std::min(pixels, capacity_ / kBlock * kBlock);
    const uint64_t together = std::min<uint64_t>(capacity_ / tile, frame.settings.samples);
    const double all = static_cast<double>(pixels) * frame.settings.samples;
    double done = 0;
    for (uint64_t pixel = 0; pixel < pixels; pixel += tile) {
        for (uint64_t sample = 0; sample < frame.settings.samples; sample += together) {
            WavefrontArgs args{};
            args.pixel_count = static_cast<uint32_t>(std::min(tile, pixels - pixel));
            args.path_count = static_cast<uint32_t>(
                args.pixel_count * std::min(together, frame.settings.samples - sample));
            args.wavefront = addresses_.address();
            args.scene = frame.scene;
            args.structure = frame.structure;
            args.frame = settings_.address();
            args.first_pixel = static_cast<uint32_t>(pixel);
            args.first_sample = static_cast<uint32_t>(sample);
            AG_CHECK(follow(stream, frame, args));
            AG_CHECK(stream.finish());
            done += args.path_count;
            monitor("rendering", done / all);
            if (monitor.cancelled()) return fail(Errc::cancelled, "rendering was interrupted");
        }
    }
    return {};
}

Status Wavefront::follow(vk::Stream& stream, const WavefrontFrame& frame,
                         WavefrontArgs args) const {
    {
        const vk::Stream::Scope scope(stream, "camera");
        stream.run(kernels_.camera, args, groups(args.path_count));
        stream.barrier();
        AG_TRY(args.alive_count, queue(stream, args));
    }
    for (; args.depth <= frame.settings.reflections && args.alive_count > 0; ++args.depth) {
        trace(stream, args);
        light(stream, frame, args);
        const vk::Stream::Scope scope(stream, "shade");
        stream.run(kernels_.finish, args, groups(args.alive_count));
        stream.barrier();
        if (args.depth < frame.settings.reflections) {
            AG_TRY(args.alive_count, queue(stream, args));
        }
    }
    const vk::Stream::Scope scope(stream, "resolve");
    stream.run(kernels_.resolve, args, groups(args.pixel_count));
    stream.barrier();
    return {};
}

/// Puts the paths that go on into the queue. Waits to learn their number: most often it is small,
/// or 0, and not to start groups that find nothing to do is worth more.
Result<uint32_t> Wavefront::queue(vk::Stream& stream, const WavefrontArgs& args) const {
    compact_.record(stream, wavefront_.alive, args.path_count, wavefront_.queue, wavefront_.queued);
    stream.barrier();
    AG_TRY(const auto count,
           stream.download<uint32_t>(paths_, 1, (wavefront_.queued - paths_.address()) / 4));
    return count[0];
}

/// Finds what the rays of the paths hit, and leaves those that may be lit in their queue.
void Wavefront::trace(vk::Stream& stream, const WavefrontArgs& args) const {
    const uint64_t flag_bytes = args.path_count * sizeof(uint32_t);
    {
        const vk::Stream::Scope scope(stream, args.depth == 0 ? "primary" : "reflections");
        stream.fill(paths_, 0, wavefront_.alive - paths_.address(), flag_bytes);
        stream.fill(paths_, 0, wavefront_.lit - paths_.address(), flag_bytes);
        stream.run(kernels_.count, args, 1);
        stream.run(kernels_.trace, args, groups(args.alive_count));
        stream.barrier();
    }
    const vk::Stream::Scope scope(stream, "shade");
    stream.run(kernels_.shade, args, groups(args.alive_count));
    stream.barrier();
    compact_.record(stream, wavefront_.lit, args.path_count, wavefront_.lit_queue,
                    wavefront_.lit_queued);
    stream.barrier();
}

/// Asks the lights what reaches the surfaces that the paths met, a few at a time.
void Wavefront::light(vk::Stream& stream, const WavefrontFrame& frame, WavefrontArgs args) const {
    const vk::Stream::Scope scope(stream, "shadow");
    if (frame.sky || frame.emitters) {
        if (frame.sky) {
            stream.run(kernels_.sky, args, groups(args.alive_count));
            ++args.first_light;
        }
        if (frame.emitters) {
            stream.run(kernels_.emitters, args, groups(args.alive_count));
            ++args.first_light;
        }
        args.light_count = std::exchange(args.first_light, 0);
        shadows(stream, kernels_.collect_area, args);
    }
    for (uint32_t light = 0; light < frame.light_count; light += kShadowSlots) {
        args.first_light = light;
        args.light_count = std::min(kShadowSlots, frame.light_count - light);
        stream.run(kernels_.lights, args, groups(uint64_t{args.alive_count} * args.light_count));
        shadows(stream, kernels_.collect_lights, args);
    }
}

/// Traces the shadow rays that have been written, and hands out what they let pass.
void Wavefront::shadows(vk::Stream& stream, const vk::Kernel& collect,
                        const WavefrontArgs& args) const {
    const uint64_t slots = uint64_t{args.alive_count} * args.light_count;
    stream.barrier();
    compact_.record(stream, wavefront_.shadow_alive, slots, wavefront_.shadow_queue,
                    wavefront_.shadow_queued);
    stream.barrier();
    stream.run(kernels_.count_shadow, args, 1);
    stream.run(kernels_.shadow, args, groups(slots));
    stream.barrier();
    stream.run(collect, args, groups(args.alive_count));
    stream.barrier();
}

}  // namespace aglow::render::gpu
