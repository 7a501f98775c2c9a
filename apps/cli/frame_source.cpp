// SPDX-License-Identifier: Apache-2.0
#include "frame_source.h"

#include "aglow/transport/path/path.h"
#include "devices.h"

#include <fmt/format.h>

namespace aglow::cli {
namespace {

class PathRenderer : public FrameRenderer {
public:
    PathRenderer(const Scene& scene, const PathOptions& options)
        : scene_(scene), options_(options) {}

    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) override {
        DrawnFrame frame;
        Stopwatch watch;
        const Surfaces surfaces = pose(scene_, time);
        frame.seconds.push_back({"pose", watch.seconds()});
        watch = {};
        AG_TRY(const RayScene rays, RayScene::create(scene_, surfaces));
        const Lights lights(scene_, surfaces, world_transforms(scene_, time));
        frame.seconds.push_back({"build", watch.seconds()});
        watch = {};
        AG_TRY(frame.luminance,
               trace_image(
                   {scene_, surfaces, rays, lights}, view.width, view.height,
                   [&](float x, float y) { return view.ray(x, y); }, options_, monitor));
        frame.seconds.push_back({"trace", watch.seconds()});
        return frame;
    }

    std::string device() const override { return "cpu"; }
    std::string accel() const override { return "embree"; }

private:
    const Scene& scene_;
    PathOptions options_;
};

/// The GPU to draw on; none: the CPU draws, which `auto` falls back to where a driver fails.
Result<std::optional<Gpu>> gpu_to_use(Console& console) {
    Result<std::optional<Gpu>> gpu = choose_device(console.options().device);
    if (gpu || console.options().device != "auto") return gpu;
    console.warn(to_string(gpu.error()) + "; the CPU draws");
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<FrameRenderer>> rays_renderer(const Footage& footage, Accel accel,
                                                     Console& console) {
    AG_TRY(const std::optional<Gpu> gpu, gpu_to_use(console));
    const auto on_cpu = [&console, footage] {
        return make_cpu_frame_renderer(footage, console.monitor());
    };
    if (!gpu) {
        if (accel != Accel::automatic)
            return fail(Errc::bad_argument,
                        fmt::format("--accel {} chooses how a GPU finds hits; the CPU has one way "
                                    "only: leave it out, or give --device gpu",
                                    name(accel)));
        return on_cpu();
    }
    const auto warn = [&console](const Error& error) {
        console.warn(to_string(error) + "; the CPU goes on");
    };
    auto renderer = make_gpu_frame_renderer(*gpu, footage, accel, console.monitor());
    if (renderer) return make_falling_back(std::move(*renderer), on_cpu, warn);
    const Errc code = renderer.error().code;
    if (code != Errc::device_lost && code != Errc::out_of_memory) return renderer;
    warn(renderer.error());
    return on_cpu();
}

Result<std::unique_ptr<FrameRenderer>> raster_renderer(const Footage& footage,
                                                       const RasterOptions& options,
                                                       Console& console) {
    const std::string& device = console.options().device;
    if (device == "cpu")
        return fail(Errc::unsupported,
                    "--engine raster draws on a GPU; leave out --device cpu, or take --engine "
                    "rays (a Vulkan driver such as mesa-vulkan-drivers makes a GPU of the CPU)");
    AG_TRY(const std::optional<Gpu> hardware, gpu_to_use(console));
    if (hardware) return make_raster_frame_renderer(*hardware, footage, options);
    AG_TRY(const std::optional<Gpu> any, choose_device("gpu"));
    return make_raster_frame_renderer(*any, footage, options);
}

std::unique_ptr<FrameRenderer> path_renderer(const Scene& scene, int bounces, int samples,
                                             uint64_t seed) {
    return std::make_unique<PathRenderer>(
        scene, PathOptions{.bounces = bounces, .samples = samples, .seed = seed});
}

}  // namespace aglow::cli
