// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/camera.h"
#include "aglow/render/frames.h"
#include "console.h"
#include "frame_range.h"
#include "report.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aglow::cli {

struct PictureSize {
    int width = 1280, height = 720;
};

/// Which frames are drawn, and what becomes of them.
struct SequenceOptions {
    static constexpr double kFps = 30;
    std::filesystem::path output;
    std::string camera = "auto";
    PictureSize size;
    std::optional<double> exposure;
    std::optional<FrameRange> frames;
    std::optional<double> fps;
};

/// Draws and writes the frames one by one. References must outlive it.
class Sequence {
public:
    /// A picture without a frame's number is of `pose_time`.
    Sequence(const SequenceOptions& options, double pose_time, const Scene& scene,
             FrameRenderer& renderer, Console& console)
        : options_(options),
          pose_time_(pose_time),
          scene_(scene),
          renderer_(renderer),
          console_(console) {}

    Status run();
    void tell(Json& report) const;
    const std::vector<std::filesystem::path>& outputs() const { return outputs_; }

private:
    Result<View> view_at(double time);
    void add(const DrawnFrame& drawn);
    Status write(Image image, const std::filesystem::path& path);

    const SequenceOptions& options_;
    double pose_time_;
    const Scene& scene_;
    FrameRenderer& renderer_;
    Console& console_;
    std::optional<View> automatic_view_;
    std::optional<float> exposure_;
    std::vector<PassTime> passes_;  // summed over the frames
    RayTally rays_;
    uint64_t triangles_ = 0;  // of the frame with the most
    float tolerance_ = 0;     // of the coarsest
    std::vector<std::filesystem::path> outputs_;
};

}  // namespace aglow::cli
