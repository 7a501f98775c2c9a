// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"

namespace aglow {
namespace {

class FallingBack : public FrameRenderer {
public:
    FallingBack(std::unique_ptr<FrameRenderer> first,
                std::function<Result<std::unique_ptr<FrameRenderer>>()> make_other,
                std::function<void(const Error&)> warn)
        : current_(std::move(first)), make_other_(std::move(make_other)), warn_(std::move(warn)) {}

    Result<DrawnFrame> draw(double time, const View& view, const Monitor& monitor) override {
        if (current_) {
            Result<DrawnFrame> frame = current_->draw(time, view, monitor);
            if (frame || !make_other_ || !device_failed(frame.error())) return frame;
            warn_(frame.error());
            current_.reset();
        }
        AG_TRY(current_, std::exchange(make_other_, nullptr)());
        return current_->draw(time, view, monitor);
    }

    std::string device() const override { return current_ ? current_->device() : "none"; }
    std::string accel() const override { return current_ ? current_->accel() : "none"; }

private:
    static bool device_failed(const Error& error) {
        return error.code == Errc::device_lost || error.code == Errc::out_of_memory;
    }

    std::unique_ptr<FrameRenderer> current_;
    std::function<Result<std::unique_ptr<FrameRenderer>>()> make_other_;  // empty once it was used
    std::function<void(const Error&)> warn_;
};

}  // namespace

std::unique_ptr<FrameRenderer> make_falling_back(
    std::unique_ptr<FrameRenderer> first,
    std::function<Result<std::unique_ptr<FrameRenderer>>()> make_other,
    std::function<void(const Error&)> warn) {
    return std::make_unique<FallingBack>(std::move(first), std::move(make_other), std::move(warn));
}

}  // namespace aglow
