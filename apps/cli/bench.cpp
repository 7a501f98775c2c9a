// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "command.h"
#include "devices.h"
#include "machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace aglow::cli {
namespace {

constexpr int kRays = 1 << 18;
constexpr int kMostRays = 1 << 26;
constexpr int kSide = 1024;
constexpr int kMostSide = 16384;

enum class Bench : uint8_t { accel, rays, refine };

struct Options {
    Bench bench = Bench::accel;
    BenchOptions settings{.scenes = {}, .rays = kRays, .side = kSide, .teaset = {}};
};

Table table(Options& o) {
    return {
        {"TABLE",
         choice<Bench>(&o.bench,
                       {{"accel", Bench::accel}, {"rays", Bench::rays}, {"refine", Bench::refine}}),
         "",
         "accel: acceleration structures on the GPU beside Embree; rays: frames drawn with them; "
         "refine: subdivision on the GPU beside the CPU",
         Need::required},
        {"--scene",
         parsed_each(&o.settings.scenes,
                     [](const std::string& text) -> Result<std::string> { return text; }),
         "NAME", "scene file or built-in scene; repeatable (default: those of the table)"},
        {"--rays", whole(&o.settings.rays, 1, kMostRays), "N",
         "rays of each kind, of accel (default 262144)"},
        {"--teaset", text(&o.settings.teaset), "FILE",
         "Bezier patches of a teapot, a spoon and a cup, for refine (docs/performance.md)"},
        {"--side", whole(&o.settings.side, 1, kMostSide), "N",
         "width and height of the pictures of rays (default 1024)"},
    };
}

BenchTable table_of(Bench bench, const BenchOptions& settings) {
    if (bench == Bench::accel) return accel_table(settings);
    return bench == Bench::rays ? rays_table(settings) : refine_table(settings);
}

/// The GPU that --device names; the best of any kind unless it names one.
Result<Gpu> gpu_to_measure(const std::string& device) {
    AG_TRY(const std::optional<Gpu> gpu, choose_device(device == "auto" ? "gpu" : device));
    if (!gpu)
        return fail(Errc::bad_argument,
                    "`aglow bench` measures a GPU beside the CPU; use --device gpu or gpu:NAME");
    return *gpu;
}

/// The first line of a table.
std::string head_of(const Json& report, const char* beside) {
    return fmt::format("{} beside {} on {}; ", report["device"].get<std::string>(), beside,
                       report["cpu"].get<std::string>());
}

Result<int> run(const Options& options, Console& console) {
    AG_TRY(const Gpu gpu, gpu_to_measure(console.options().device));
    const BenchOptions& settings = options.settings;
    const BenchTable measured = table_of(options.bench, settings);
    Json report = {{"device", info(*gpu).name},
                   {"driver", info(*gpu).driver},
                   {"cpu", processor(console.options().threads)}};
    report.update(measured.settings);
    report["scenes"] = Json::array();
    for (const std::string& scene : settings.scenes.empty() ? measured.scenes : settings.scenes) {
        AG_CHECK(console.go_on(scene));
        AG_TRY(const Json rows, measured.measure(gpu, scene, settings, console));
        report["scenes"].insert(report["scenes"].end(), rows.begin(), rows.end());
    }
    console.result(console.json() ? to_text(report) + "\n"
                                  : head_of(report, measured.beside) + measured.text(report));
    return kExitDone;
}

}  // namespace

std::vector<std::string> bench_scenes() {
    return {"cad:50000", "cad:112000", "cad:470000", "walker", "marbles", "toys", "forest"};
}

Result<Scene> bench_scene(const std::string& name) {
    const auto is_known = [&](const BuiltinScene& known) {
        const size_t family = known.name.find(':');
        return known.name == name ||
               (family != std::string::npos && name.starts_with(known.name.substr(0, family + 1)));
    };
    const auto known = builtin_scenes();
    Result<Scene> scene =
        std::any_of(known.begin(), known.end(), is_known) ? builtin_scene(name) : load_scene(name);
    if (scene)
        for (Material& material : scene->materials) material.alpha_mode = AlphaMode::opaque;
    return scene;
}

Command bench_command() {
    Command bench = command("bench", "TABLE [options]",
                            "measures this machine: published tables, repeated here", table, run);
    bench.on_gpu = true;
    return bench;
}

}  // namespace aglow::cli
