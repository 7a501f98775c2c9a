// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/solve.h"

namespace aglow {
namespace {

struct Effort {
    int cache_samples;
    int64_t cache_rays;
    int min_samples, max_samples;
    float target_error;
};

Effort effort(Quality quality, Target target) {
    if (target == Target::sensors) {
        switch (quality) {
            case Quality::draft:
                return {16, 1 << 20, 512, 4096, 0.01f};
            case Quality::medium:
                return {32, 1 << 22, 2048, 32768, 0.003f};
            case Quality::high:
                return {64, 1 << 23, 8192, 262144, 0.001f};
        }
    }
    switch (quality) {
        case Quality::draft:
            return {16, 1 << 18, 32, 128, 0.05f};
        case Quality::medium:
            return {32, 1 << 21, 64, 512, 0.02f};
        case Quality::high:
            break;
    }
    return {64, 1 << 23, 256, 4096, 0.005f};
}

}  // namespace

int sample_points(Quality quality) {
    return quality == Quality::draft ? 4 : quality == Quality::medium ? 8 : 16;
}

GatherOptions gather_options(const SolveOptions& options, Target target) {
    const Effort e = effort(options.quality, target);
    GatherOptions result{options.bounces, e.cache_samples, e.cache_rays, e.min_samples,
                         e.max_samples,   e.target_error,  options.seed};
    if (options.samples > 0) result.min_samples = result.max_samples = options.samples;
    return result;
}

PathOptions path_options(const SolveOptions& options, Target target) {
    const Effort e = effort(options.quality, target);
    const int samples = options.samples > 0 ? options.samples : e.max_samples;
    return {options.bounces, samples, options.seed};
}

}  // namespace aglow
