// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/encode/lit_gltf.h"
#include "aglow/render/camera.h"
#include "aglow/render/rays.h"
#include "aglow/vk/devices.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace aglow {

/// A scene to draw at any time. The scene must outlive what draws it and stay as it is.
struct Footage {
    const Scene& scene;
    const Lit* lit =
        nullptr;  ///< light baked in the rest pose; null: light is computed on the spot
    RaysOptions options = {};
};

struct PassTime {
    std::string pass;
    double seconds = 0;
};

struct DrawnFrame {
    Image luminance;                ///< cd/m^2
    std::vector<PassTime> seconds;  ///< of the passes, in their order
    RayTally rays;                  ///< of this frame; all 0 where nobody counts
    uint64_t triangles = 0;         ///< that were rasterized
    float tolerance = 0;            ///< pixels that refined edges may be off; 0: nobody asked
};

/// Draws a scene with engine `rays`, frame by frame: what render_rays() says, on some device.
class FrameRenderer {
public:
    virtual ~FrameRenderer() = default;
    /// The scene at `time` seconds (negative: the rest pose).
    /// Errors  as render_rays(), device_lost. After device_lost or out_of_memory it draws no more.
    virtual Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) = 0;

    virtual std::string device() const = 0;  ///< "cpu", or the GPU's name
    virtual std::string accel() const = 0;   ///< what finds hits: "embree", "grid", "bvh", ...
};

/// Draws on the CPU.
/// Errors  bad_argument (samples or reflections out of range), cancelled, out_of_memory.
Result<std::unique_ptr<FrameRenderer>> make_cpu_frame_renderer(const Footage& footage,
                                                               const Monitor& monitor = {});

/// Draws on the GPU: the same picture but for rounding.
/// Errors  as make_cpu_frame_renderer(); unsupported, device_lost.
Result<std::unique_ptr<FrameRenderer>> make_gpu_frame_renderer(const Gpu& gpu,
                                                               const Footage& footage, Accel accel,
                                                               const Monitor& monitor = {});

/// Draws with `first` until that loses its device or runs out of memory, tells `warn` so, and draws
/// that frame and all after it with what `make_other` makes. `first` is given back before.
/// Errors  of what `make_other` makes.
std::unique_ptr<FrameRenderer> make_falling_back(
    std::unique_ptr<FrameRenderer> first,
    std::function<Result<std::unique_ptr<FrameRenderer>>()> make_other,
    std::function<void(const Error&)> warn);

}  // namespace aglow
