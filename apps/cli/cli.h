// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace aglow::cli {

/// Runs `aglow` with the words after the program's name. Prints; never throws.
/// Result  the exit code: 0 done, 1 usage, 2 could not read or write, 3 invalid input, 4 run-time
///         failure, 5 unsupported feature, 7 a compared difference exceeds its bound, 130
///         interrupted.
int run(const std::vector<std::string>& words);

}  // namespace aglow::cli
