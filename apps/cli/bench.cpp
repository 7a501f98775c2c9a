// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "command.h"

#include <algorithm>
#include <functional>

namespace aglow::cli {
namespace {

constexpr int kRays = 1 << 18;
constexpr int kMostRays = 1 << 26;
constexpr int kSide = 1024;
constexpr int kMostSide = 16384;

enum class Bench : uint8_t { accel, rays };

struct Options {
    Bench bench = Bench::accel;
    BenchOptions settings{.scenes = {}, .rays = kRays, .side = kSide};
};

Table table(Options& o) {
    return {
        {"TABLE", choice<Bench>(&o.bench, {{"accel", Bench::accel}, {"rays", Bench::rays}}), "",
         "accel: acceleration structures on the GPU beside Embree; rays: frames drawn with them",
         Need::required},
        {"--scene",
         parsed_each(&o.settings.scenes,
                     [](const std::string& text) -> Result<std::string> { return text; }),
         "NAME", "scene file or built-in scene; repeatable (default: still and moving ones)"},
        {"--rays", whole(&o.settings.rays, 1, kMostRays), "N",
         "rays of each kind, of accel (default 262144)"},
        {"--side", whole(&o.settings.side, 1, kMostSide), "N",
         "width and height of the pictures of rays (default 1024)"},
    };
}

Result<int> run(const Options& options, Console& console) {
    const auto measure = options.bench == Bench::accel ? bench_accel : bench_rays;
    AG_TRY(const BenchTable measured, measure(options.settings, console));
    console.result(console.json() ? to_text(measured.json) + "\n" : measured.text);
    return kExitDone;
}

}  // namespace

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

Result<Gpu> bench_gpu(const Console& console) {
    const std::string& device = console.options().device;
    if (device == "cpu")
        return fail(Errc::bad_argument,
                    "`aglow bench` measures a GPU beside the CPU; use --device gpu or gpu:NAME");
    constexpr std::string_view kPrefix = "gpu:";
    return open_gpu(device.starts_with(kPrefix) ? device.substr(kPrefix.size()) : "");
}

Command bench_command() {
    Command bench = command("bench", "TABLE [options]",
                            "measures this machine: published tables, repeated here", table, run);
    bench.on_gpu = true;
    return bench;
}

}  // namespace aglow::cli
