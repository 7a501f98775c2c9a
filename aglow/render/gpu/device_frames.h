// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/frames.h"
#include "aglow/vk/device.h"
#include "aglow/vk/stream.h"

#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace aglow::render::gpu {

/// What renderers on a device have in common: after a failure they draw no more, memory that
/// cannot be had is an error, and passes are timed.
class DeviceFrameRenderer : public FrameRenderer {
public:
    explicit DeviceFrameRenderer(vk::Stream stream) : stream_(std::move(stream)) {}
    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) final;
    std::string device() const final { return gpu()->info().name; }

protected:
    /// A frame without times. The view is not empty.
    virtual Result<DrawnFrame> draw_frame(double time, const View& view,
                                          const Monitor& monitor) = 0;
    vk::Stream& stream() { return stream_; }
    const Gpu& gpu() const { return stream_.gpu(); }

private:
    vk::Stream stream_;
    std::optional<Error> failure_;  // after which nothing is drawn
};

/// A Renderer(stream, footage) on which prepare(arguments...) was called.
/// Errors  of its prepare(); out_of_memory, device_lost.
template <class Renderer, class... Arguments>
Result<std::unique_ptr<FrameRenderer>> make_prepared(const Gpu& gpu, const Footage& footage,
                                                     const Arguments&... arguments) try {
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    auto renderer = std::make_unique<Renderer>(std::move(stream), footage);
    AG_CHECK(renderer->prepare(arguments...));
    return renderer;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to prepare the scene");
}

}  // namespace aglow::render::gpu
