// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/device_frames.h"

#include "aglow/render/gpu/pass_times.h"

#include <fmt/format.h>

#include <chrono>

namespace aglow::render::gpu {

Result<DrawnFrame> DeviceFrameRenderer::draw(double time, const View& view,
                                             const Monitor& monitor) try {
    if (failure_) return tl::unexpected<Error>(*failure_);
    if (view.width < 1 || view.height < 1)
        return fail(Errc::bad_argument,
                    fmt::format("an image of {}x{} pixels is empty", view.width, view.height));
    const auto start = std::chrono::steady_clock::now();
    Result<DrawnFrame> frame = draw_frame(time, view, monitor);
    if (!frame) {
        if (frame.error().code != Errc::cancelled) failure_ = frame.error();
        return frame;
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    frame->seconds = pass_times(stream_.take_timings(), wall.count());
    return frame;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", view.width, view.height));
}

}  // namespace aglow::render::gpu
