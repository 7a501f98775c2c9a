// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include "aglow/accel/ray_scene.h"
#include "aglow/render/tone_map.h"
#include "aglow/scene/image_file.h"

#include <algorithm>
#include <utility>

namespace aglow::cli {

Status Sequence::run() {
    const FrameRange range = options_.frames.value_or(FrameRange{});
    const double share = 1.0 / (range.last - range.first + 1);
    for (int frame = range.first; frame <= range.last; ++frame) {
        const double time =
            options_.frames ? frame / options_.fps.value_or(SequenceOptions::kFps) : pose_time_;
        AG_TRY(const View view, view_at(time));
        const Monitor whole = console_.monitor();
        const Monitor part{[&](std::string_view stage, double fraction) {
                               whole.report(stage, (frame - range.first + fraction) * share);
                           },
                           whole.cancel};
        AG_TRY(DrawnFrame drawn, renderer_.draw(time, view, part));
        add(drawn);
        AG_CHECK(write(std::move(drawn.luminance),
                       options_.frames ? numbered(options_.output, frame) : options_.output));
    }
    return {};
}

void Sequence::tell(Json& report) const {
    report["accel"] = renderer_.accel();
    if (options_.output.extension() == ".png") report["exposure_ev"] = exposure_.value_or(0);
    report["frames"] = outputs_.size();
    Json passes = Json::array();
    for (const PassTime& pass : passes_)
        passes.push_back({{"pass", pass.pass},
                          {"seconds", pass.seconds / static_cast<double>(outputs_.size())}});
    report["passes"] = passes;
    if (triangles_ > 0) report["triangles"] = triangles_;
    if (tolerance_ > 0) report["tolerance_pixels"] = tolerance_;
    if (rays_.total() == 0) return;
    report["rays"] = rays_.total();
    report["rays_by_kind"] = {
        {"camera", rays_.camera}, {"mirror", rays_.mirror}, {"shadow", rays_.shadow}};
}

/// A view that depends on the pose is that of the first frame, for all.
Result<View> Sequence::view_at(double time) {
    const auto [width, height] = options_.size;
    AG_TRY(auto view, camera_view(scene_, options_.camera, width, height, time));
    if (view) return *view;
    if (!automatic_view_) {
        const Surfaces surfaces = pose(scene_, time);
        AG_TRY(const RayScene rays, RayScene::create(scene_, surfaces));
        AG_TRY(automatic_view_,
               choose_view(scene_, surfaces, rays, options_.camera, width, height, time));
    }
    return *automatic_view_;
}

void Sequence::add(const DrawnFrame& drawn) {
    rays_ += drawn.rays;
    triangles_ = std::max(triangles_, drawn.triangles);
    tolerance_ = std::max(tolerance_, drawn.tolerance);
    for (const PassTime& pass : drawn.seconds) {
        const auto known = std::find_if(passes_.begin(), passes_.end(),
                                        [&](const PassTime& p) { return p.pass == pass.pass; });
        if (known == passes_.end())
            passes_.push_back(pass);
        else
            known->seconds += pass.seconds;
    }
}

/// The exposure of the first frame holds for all, so that nothing flickers.
Status Sequence::write(Image image, const std::filesystem::path& path) {
    if (path.extension() == ".png") {
        if (!exposure_)
            exposure_ = options_.exposure ? static_cast<float>(*options_.exposure)
                                          : automatic_exposure(image);
        image = tone_map(image, *exposure_);
    }
    AG_CHECK(write_image(image, path));
    outputs_.push_back(path);
    return {};
}

}  // namespace aglow::cli
