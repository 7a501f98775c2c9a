// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "console.h"
#include "report.h"

#include <string>
#include <vector>

namespace aglow::cli {

/// What `aglow bench` is asked for.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< files or built-in names; none: the table's own
    int rays = 0;                     ///< of each kind
};

/// A table as JSON, and the same as text for people.
struct BenchTable {
    Json json;
    std::string text;
};

/// Builds and traces each structure on the device that was asked for, and Embree beside it.
Result<BenchTable> bench_accel(const BenchOptions& options, Console& console);

}  // namespace aglow::cli
