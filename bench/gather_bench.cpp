// SPDX-License-Identifier: Apache-2.0
// How fast the gather solver is: rays per second, what a second thread gives, and how time grows
// with texels.   gather_bench [SCENE.glb | built-in name] [samples per texel]
#include "aglow/bake/bake.h"
#include "aglow/core/parallel.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

using namespace aglow;

namespace {

struct Timing {
    double texels = 0, rays = 0, seconds = 0;
};

/// The best of `repeats` bakes: what else runs on the machine only ever adds time.
Result<Timing> time_bake(const Scene& scene, int resolution, int samples, int threads,
                         int repeats) {
    const ThreadLimit limit(threads);
    BakeOptions options;
    options.solve.samples = samples;
    options.unwrap.resolution = resolution;
    Timing best;
    for (int i = 0; i < repeats; ++i) {
        AG_TRY(const Baked baked, bake(scene, options));
        if (best.seconds != 0 && baked.seconds.solve >= best.seconds) continue;
        best = {static_cast<double>(baked.texels.element_count()),
                static_cast<double>(baked.field.ray_count), baked.seconds.solve};
    }
    return best;
}

/// Coefficient of determination of the straight line through the points (texels, seconds).
double linearity(const std::vector<Timing>& points) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (const Timing& p : points) {
        n += 1;
        sx += p.texels;
        sy += p.seconds;
        sxx += p.texels * p.texels;
        sxy += p.texels * p.seconds;
        syy += p.seconds * p.seconds;
    }
    const double covariance = n * sxy - sx * sy;
    return covariance * covariance / ((n * sxx - sx * sx) * (n * syy - sy * sy));
}

/// Exponent of the power law through the first and last point: 1 where time is linear.
double growth(const std::vector<Timing>& points) {
    return std::log(points.back().seconds / points.front().seconds) /
           std::log(points.back().texels / points.front().texels);
}

Status run(const std::string& name, int samples) {
    auto builtin = builtin_scene(name);
    if (!builtin) builtin = load_scene(name);
    AG_TRY(const Scene scene, std::move(builtin));

    AG_TRY(const Timing one, time_bake(scene, 512, samples, 1, 2));
    AG_TRY(const Timing two, time_bake(scene, 512, samples, 2, 2));
    fmt::print("| threads | texels | rays | seconds | Mrays/s |\n|---|---|---|---|---|\n");
    for (const auto& [threads, t] : {std::pair{1, one}, std::pair{2, two}})
        fmt::print("| {} | {:.0f} | {:.0f} | {:.3f} | {:.2f} |\n", threads, t.texels, t.rays,
                   t.seconds, t.rays / t.seconds / 1e6);
    fmt::print("\nTwo threads: {:.2f} times one.\n\n", one.seconds / two.seconds);

    std::vector<Timing> points;
    fmt::print("| resolution | texels | seconds | us per texel |\n|---|---|---|---|\n");
    for (int resolution : {128, 256, 512, 1024}) {
        AG_TRY(const Timing t, time_bake(scene, resolution, samples, 2, resolution > 512 ? 1 : 2));
        fmt::print("| {} | {:.0f} | {:.3f} | {:.3f} |\n", resolution, t.texels, t.seconds,
                   t.seconds / t.texels * 1e6);
        points.push_back(t);
    }
    fmt::print("\nStraight line: R^2 = {:.5f}; time grows as texels^{:.3f}.\n", linearity(points),
               growth(points));
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    const std::string name = argc > 1 ? argv[1] : "cornell-box";
    const int samples = argc > 2 ? std::atoi(argv[2]) : 64;
    if (const Status status = run(name, std::max(samples, 1)); !status) {
        fmt::print(stderr, "{}\n", to_string(status.error()));
        return 1;
    }
    return 0;
}
