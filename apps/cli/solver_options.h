// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/bake/bake.h"
#include "aglow/core/result.h"
#include "options.h"
#include "report.h"

#include <optional>
#include <string>

namespace aglow::cli {

/// How light is computed: the options that bake and measure share.
struct SolverOptions {
    Method method = Method::gather;
    std::optional<Quality> quality;
    std::optional<int> samples;
    int bounces = kConverged;
    std::optional<double> texel_size;
    std::optional<int> resolution;
};

Table solver_table(SolverOptions& options);

/// The same for the library.
/// Errors  bad_argument  options that contradict each other; says which to leave out.
Result<BakeOptions> bake_options(const SolverOptions& options, double time, uint64_t seed);

/// A whole number of reflections, or "auto" for kConverged.
Result<int> parse_bounces(const std::string& text);

std::string name(Method method);
std::string name(Quality quality);

/// Adds what was asked for to `settings`.
void describe(const BakeOptions& options, Json& settings);

}  // namespace aglow::cli
