// SPDX-License-Identifier: Apache-2.0
#include "solver_options.h"

namespace aglow::cli {
namespace {

constexpr int kMostSamples = 1 << 24;
constexpr int kMostBounces = 1000;
constexpr int kFinestResolution = 16384;

}  // namespace

Table solver_table(SolverOptions& o) {
    return {
        {"--method",
         choice<Method>(&o.method, {{"gather", Method::gather}, {"path", Method::path}},
                        {"progressive", "hierarchical"}),
         "NAME", "gather (default), or path: the brute-force reference"},
        {"--quality",
         choice<Quality>(
             &o.quality,
             {{"draft", Quality::draft}, {"medium", Quality::medium}, {"high", Quality::high}}),
         "NAME", "draft, medium (default) or high"},
        {"--samples", whole(&o.samples, 1, kMostSamples), "N",
         "instead of --quality: hemisphere samples per texel or sensor"},
        {"--bounces", parsed(&o.bounces, parse_bounces), "N|auto",
         "diffuse reflections; 0: direct light only; auto (default): until they die out"},
        {"--texel-size", number_above(&o.texel_size, 0), "M", "edge length of a texel, metres"},
        {"--resolution", whole(&o.resolution, 1, kFinestResolution), "N",
         "instead of --texel-size: width of the lightmap in texels (default 1024)"},
    };
}

Result<int> parse_bounces(const std::string& text) {
    if (text == "auto") return kConverged;
    AG_TRY(const int64_t bounces, parse_whole(text, 0, kMostBounces));
    return static_cast<int>(bounces);
}

Result<BakeOptions> bake_options(const SolverOptions& options, double time, uint64_t seed) {
    if (options.quality && options.samples)
        return fail(Errc::bad_argument,
                    "--quality and --samples contradict each other; give one of them");
    if (options.texel_size && options.resolution)
        return fail(Errc::bad_argument,
                    "--texel-size and --resolution contradict each other; give one of them");
    BakeOptions result;
    result.solve = {.method = options.method,
                    .quality = options.quality.value_or(Quality::medium),
                    .samples = options.samples.value_or(0),
                    .bounces = options.bounces,
                    .time = time,
                    .seed = seed};
    result.unwrap.texel_size = static_cast<float>(options.texel_size.value_or(0));
    if (options.resolution) result.unwrap.resolution = *options.resolution;
    return result;
}

std::string name(Method method) { return method == Method::gather ? "gather" : "path"; }

std::string name(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return "draft";
        case Quality::medium:
            return "medium";
        case Quality::high:
            return "high";
    }
    return "";
}

void describe(const BakeOptions& options, Json& settings) {
    const SolveOptions& solve = options.solve;
    settings["method"] = name(solve.method);
    if (solve.samples > 0)
        settings["samples"] = solve.samples;
    else
        settings["quality"] = name(solve.quality);
    if (solve.bounces == kConverged)
        settings["bounces"] = "auto";
    else
        settings["bounces"] = solve.bounces;
    if (options.unwrap.texel_size > 0)
        settings["texel_size"] = options.unwrap.texel_size;
    else
        settings["resolution"] = options.unwrap.resolution;
    settings["seed"] = solve.seed;
}

}  // namespace aglow::cli
