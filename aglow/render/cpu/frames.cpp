// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"

#include "aglow/mesh/unwrap.h"
#include "aglow/render/cpu/draw.h"
#include "aglow/render/tables/resting_light.h"

#include <chrono>
#include <new>

namespace aglow {
namespace render::cpu {
namespace {

/// Seconds since it was made or asked last.
class Lap {
public:
    double seconds() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class CpuFrameRenderer : public FrameRenderer {
public:
    explicit CpuFrameRenderer(const Footage& footage)
        : scene_(footage.scene), lit_(footage.lit), options_(footage.options) {}

    Status prepare(const Monitor& monitor) {
        AG_CHECK(check(options_));
        moves_ = has_motion(scene_);
        tables_ = shared_tables(scene_, pose(scene_), lit_ != nullptr, options_);
        const bool punctual = !punctual_lights(scene_, world_transforms(scene_)).empty();
        if (lit_ && moves_ && punctual) {
            AG_TRY(resting_, resting_light(scene_, *lit_, monitor));
        }
        return {};
    }

    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) override try {
        DrawnFrame frame;
        Lap lap;
        const Surfaces surfaces = pose(scene_, time, lit_ ? &lit_->atlas : nullptr);
        frame.seconds.push_back({"pose", lap.seconds()});
        AG_TRY(const RayScene rays, RayScene::create(scene_, surfaces));
        frame.seconds.push_back({"build", lap.seconds()});
        const World world{
            scene_,  surfaces,           rays,
            tables_, stored_light(time), punctual_lights(scene_, world_transforms(scene_, time))};
        AG_TRY(frame.luminance, cpu::draw(world, view, options_, monitor, frame.rays));
        frame.seconds.push_back({"trace", lap.seconds()});
        return frame;
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "not enough memory to pose the scene");
    }

    std::string device() const override { return "cpu"; }
    std::string accel() const override { return "embree"; }

private:
    /// At rest, what was baked; else what rests of it.
    StoredLight stored_light(double time) const {
        if (!lit_) return {};
        if (time < 0 || resting_.pixels.empty()) return {&lit_->irradiance, true};
        return {&resting_, false};
    }

    const Scene& scene_;
    const Lit* lit_;
    RaysOptions options_;
    bool moves_ = false;
    SharedTables tables_;
    Image resting_;  // empty where all light may stay as baked
};

}  // namespace
}  // namespace render::cpu

Result<std::unique_ptr<FrameRenderer>> make_cpu_frame_renderer(const Footage& footage,
                                                               const Monitor& monitor) try {
    auto renderer = std::make_unique<render::cpu::CpuFrameRenderer>(footage);
    AG_CHECK(renderer->prepare(monitor));
    return renderer;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to prepare the scene");
}

}  // namespace aglow
