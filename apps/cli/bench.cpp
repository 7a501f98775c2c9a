// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include "command.h"

#include <functional>

namespace aglow::cli {
namespace {

constexpr int kRays = 1 << 18;
constexpr int kMostRays = 1 << 26;

enum class Bench : uint8_t { accel };

struct Options {
    Bench bench = Bench::accel;
    BenchOptions settings{.scenes = {}, .rays = kRays};
};

Table table(Options& o) {
    return {
        {"TABLE", choice<Bench>(&o.bench, {{"accel", Bench::accel}}), "",
         "accel: acceleration structures on the GPU beside Embree", Need::required},
        {"--scene",
         parsed_each(&o.settings.scenes,
                     [](const std::string& text) -> Result<std::string> { return text; }),
         "NAME", "scene file or built-in scene; repeatable (default: seven still and moving ones)"},
        {"--rays", whole(&o.settings.rays, 1, kMostRays), "N",
         "rays of each kind (default 262144)"},
    };
}

Result<int> run(const Options& options, Console& console) {
    AG_TRY(const BenchTable measured, bench_accel(options.settings, console));
    console.result(console.json() ? to_text(measured.json) + "\n" : measured.text);
    return kExitDone;
}

}  // namespace

Command bench_command() {
    Command bench = command("bench", "TABLE [options]",
                            "measures this machine: published tables, repeated here", table, run);
    bench.on_gpu = true;
    return bench;
}

}  // namespace aglow::cli
