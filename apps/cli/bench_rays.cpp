// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/frames.h"
#include "bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::cli {
namespace {

constexpr int kFrames = 3;            // after one that is not counted: shaders are compiled in it
constexpr double kStep = 1.0 / 30;    // s between frames
constexpr float kRoughness = 0.2f;    // of all surfaces, so that each shows a mirror image
constexpr float kLuminousFlux = 1e5;  // lm, of the one light

constexpr std::array kEffects = {"primary", "shadow", "reflection"};

/// Without light of its own: the same rays are shot in every scene.
Scene dark(Scene scene) {
    for (Material& material : scene.materials) {
        material.emission = {0, 0, 0};
        material.roughness = kRoughness;
        material.unlit = false;
    }
    for (Node& node : scene.nodes) node.light = -1;
    scene.lights.clear();
    scene.sky.reset();
    return scene;
}

/// With one light below the top of the scene, so that each lit surface asks for one shadow ray.
Scene lit(Scene scene, const Box& box) {
    const vec3 size = box.size();
    add_point_light(scene, box.center() + vec3{0.11f * size.x, 0.47f * size.y, 0.13f * size.z},
                    kLuminousFlux);
    return scene;
}

struct Stage {
    Scene dark, lit;
    View view;
    size_t triangles = 0;
    bool moving = false;
};

Result<Stage> make_stage(Scene scene, bool moving, int side) {
    if (!moving) scene.animations.clear();
    const Surfaces surfaces = pose(scene, kBenchTime);
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    AG_TRY(const View view, choose_view(scene, surfaces, rays, "auto", side, side, kBenchTime));
    Box box;
    for (const vec3 p : surfaces.positions) box.add(p);
    Stage stage{dark(std::move(scene)), {}, view, surfaces.triangles.size(), moving};
    stage.lit = lit(stage.dark, box);
    return stage;
}

using Renderer = Result<std::unique_ptr<FrameRenderer>>;

/// Milliseconds of a frame, whole and by pass, and its rays; means over the frames.
Result<Json> measure_frames(Renderer made, const Stage& stage) {
    AG_TRY(const auto renderer, std::move(made));
    std::vector<PassTime> passes;
    double seconds = 0;
    RayTally rays;
    for (int frame = 0; frame <= kFrames; ++frame) {
        const Stopwatch watch;
        AG_TRY(const DrawnFrame drawn, renderer->draw(kBenchTime + frame * kStep, stage.view, {}));
        if (frame == 0) continue;
        seconds += watch.seconds() / kFrames;
        rays += drawn.rays;
        for (const PassTime& pass : drawn.seconds) {
            auto known = std::find_if(passes.begin(), passes.end(),
                                      [&](const PassTime& p) { return p.pass == pass.pass; });
            if (known == passes.end()) known = passes.insert(passes.end(), {pass.pass, 0});
            known->seconds += pass.seconds / kFrames;
        }
    }
    Json stages = Json::object();
    for (const PassTime& pass : passes) stages[pass.pass] = pass.seconds * 1e3;
    const double rays_per_frame = static_cast<double>(rays.total()) / kFrames;
    return Json{{"frame_ms", seconds * 1e3},
                {"rays", std::llround(rays_per_frame)},
                {"mrays_per_second", rays_per_frame / seconds / 1e6},
                {"stage_ms", stages}};
}

/// Frames with each of the effects; `make` makes what draws them.
Result<Json> measure_effects(const Stage& stage, const auto& make) {
    Json row;
    for (const char* effect : kEffects) {
        const bool mirrors = effect == kEffects[2];
        const Scene& scene = effect == kEffects[0] ? stage.dark : stage.lit;
        const RaysOptions options{
            .samples = 1, .reflections = mirrors ? 1 : 0, .shading = Shading::phong};
        AG_TRY(row[effect], measure_frames(make(Footage{scene, nullptr, options}), stage));
    }
    return row;
}

Result<Json> measure_stage(const Gpu& gpu, const std::string& name, const Stage& stage,
                           Console& console) {
    const char* motion = stage.moving ? "moving" : "still";
    Json rows = Json::array();
    const auto add = [&](const char* accel, const auto& make) -> Status {
        AG_CHECK(console.go_on(fmt::format("{}, {}, {}", name, motion, accel)));
        AG_TRY(Json measured, measure_effects(stage, make));
        Json row = {{"accel", accel}};
        row.update(measured);
        rows.push_back(row);
        return {};
    };
    AG_CHECK(add("embree", [](const Footage& f) { return make_cpu_frame_renderer(f); }));
    for (const Accel accel : kBenchAccels)
        AG_CHECK(add(aglow::name(accel),
                     [&](const Footage& f) { return make_gpu_frame_renderer(gpu, f, accel); }));
    return Json{
        {"scene", name}, {"motion", motion}, {"triangles", stage.triangles}, {"structures", rows}};
}

/// Standing still, and in motion where it moves.
Result<Json> measure(const Gpu& gpu, const std::string& name, const BenchOptions& options,
                     Console& console) {
    AG_TRY(const Scene scene, bench_scene(name));
    Json measured = Json::array();
    for (const bool moving : {false, true}) {
        if (moving && scene.animations.empty()) continue;
        AG_TRY(const Stage stage, make_stage(scene, moving, options.side));
        AG_TRY(Json row, measure_stage(gpu, name, stage, console));
        measured.push_back(row);
    }
    return measured;
}

/// The passes of a frame in a few words: "pose 1.2, build 3.4, ...", milliseconds.
std::string stages_of(const Json& frame) {
    std::string text;
    for (const auto& [pass, ms] : frame["stage_ms"].items())
        text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ", pass, ms.get<double>());
    return text;
}

std::string text_of(const Json& report) {
    const int side = report["side"].get<int>();
    std::string text =
        fmt::format("milliseconds of a frame of {} x {} pixels with one ray each\n", side, side);
    for (const Json& scene : report["scenes"]) {
        text += fmt::format("\n{}, {}: {} triangles\n  {:<7} {:>9} {:>9} {:>11}\n",
                            scene["scene"].get<std::string>(), scene["motion"].get<std::string>(),
                            scene["triangles"].get<size_t>(), "", "primary", "+ shadow",
                            "+ reflection  stages of the last");
        for (const Json& row : scene["structures"]) {
            text += fmt::format("  {:<7}", row["accel"].get<std::string>());
            for (const char* effect : kEffects)
                text += fmt::format(" {:>9.1f}", row[effect]["frame_ms"].get<double>());
            text += fmt::format("     {}\n", stages_of(row[kEffects.back()]));
        }
    }
    return text;
}

}  // namespace

BenchTable rays_table(const BenchOptions& options) {
    std::vector<std::string> scenes = bench_scenes();
    scenes.emplace_back("scatter");  // whose triangles fly apart as time goes on
    return {scenes, {{"side", options.side}}, measure, text_of};
}

}  // namespace aglow::cli
