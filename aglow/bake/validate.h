// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/bake/bake.h"
#include "aglow/core/progress.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aglow {

struct ValidationOptions {
    Method method = Method::gather;
    Quality quality = Quality::high;
    /// Factors on every length: 0.001 makes metres into millimetres. Lights are scaled along, so
    /// that the expected illuminance does not change.
    std::vector<double> scales = {0.001, 1, 1000};
    std::string filter;  ///< only cases whose "group: name" contains it; empty: all
    uint64_t seed = 0;
};

/// One quantity of one scene at one scale, beside the value that theory gives for it.
struct ValidationCase {
    std::string group;     ///< what is tested: "point light", "furnace", ...
    std::string name;      ///< the scene within the group
    std::string quantity;  ///< what is measured: "E at the sensor", "mean E of the square", ...
    std::string unit;      ///< lx or lm
    std::string source;    ///< the closed form that gives `expected`
    double scale = 1;
    double expected = 0;
    double measured = 0;
    /// (measured - expected) / expected; where 0 is expected, measured over what would arrive if
    /// nothing stood in the light's way.
    double error = 0;
    double tolerance = 0;  ///< bound on |error|; 0 where darkness is expected
    double seconds = 0;    ///< for the whole scene, which may serve several cases
    bool passed() const { return error <= tolerance && -error <= tolerance; }  ///< false for NaN
};

/// Bound on the relative error that `validate` holds each quality to.
double validation_tolerance(Quality quality);

/// Number of cases one scale has (with no filter).
int validation_case_count();

/// Builds every analytic scene in memory, measures it through bake() and measure(), the route that
/// users take, and compares with closed forms.
/// Result  in the order of the cases, scales innermost. A deviation is a value, not an error:
///         read passed().
/// Errors  those of bake() and measure(); bad_argument where the filter leaves no case or a scale
///         is not positive.
/// Repeat  same values for any thread count and run, for one seed.
Result<std::vector<ValidationCase>> validate(const ValidationOptions& options,
                                             const Monitor& monitor = {});

/// Aligned plain text for a terminal: one line per case and scale, a summary at the end.
std::string validation_table(const std::vector<ValidationCase>& cases);

/// One JSON object: {"passed", "cases": [...], "failed", "worst_error"}.
std::string validation_json(const std::vector<ValidationCase>& cases);

/// What a reader needs to repeat a table.
struct ValidationRun {
    std::string command;  ///< `aglow validate --markdown`
    std::string date;     ///< ISO 8601
    std::string device;   ///< processor and threads
    Method method = Method::gather;
    Quality quality = Quality::high;
};

/// docs/validation.md: one row per case, one pair of columns per scale.
std::string validation_markdown(const std::vector<ValidationCase>& cases, const ValidationRun& run);

}  // namespace aglow
