// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "console.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace aglow::cli {

/// What a command found out, in the order in which it is told.
using Json = nlohmann::ordered_json;

/// Prints the report: as JSON if asked for, else as aligned lines that say the same.
void print_report(Console& console, const Json& report);

/// Text of JSON; bytes of file names that are not UTF-8 are replaced.
std::string to_text(const Json& json, int indent = -1);

/// File names as strings.
Json names(const std::vector<std::filesystem::path>& paths);

/// Rounded to milliseconds: what a stopwatch can honestly say.
double rounded_seconds(double seconds);

}  // namespace aglow::cli
