// SPDX-License-Identifier: Apache-2.0
#include "frame_source.h"

#include "aglow/transport/path/path.h"

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

bool is_gpu(const std::string& device) { return device.starts_with("gpu"); }

}  // namespace

Result<std::unique_ptr<FrameRenderer>> rays_renderer(const Footage& footage, Accel accel,
                                                     Console& console) {
    if (is_gpu(console.options().device))
        return fail(Errc::unsupported, "this build draws on the CPU; use --device cpu");
    if (accel != Accel::automatic)
        return fail(Errc::bad_argument,
                    "--accel chooses how a GPU finds hits; the CPU has one way only: leave it out");
    return make_cpu_frame_renderer(footage, console.monitor());
}

std::unique_ptr<FrameRenderer> path_renderer(const Scene& scene, int bounces, int samples,
                                             uint64_t seed) {
    return std::make_unique<PathRenderer>(
        scene, PathOptions{.bounces = bounces, .samples = samples, .seed = seed});
}

}  // namespace aglow::cli
