// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aglow::cli {
namespace {

/// One value on one line.
std::string line_of(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_null()) return "-";
    if (!value.is_structured()) return to_text(value);
    std::string line;
    for (const auto& [key, item] : value.items())
        line += fmt::format("{}{}{}{}", line.empty() ? "" : ", ", value.is_object() ? key : "",
                            value.is_object() ? " " : "", line_of(item));
    return line;
}

bool many_lines(const Json& value) {
    return value.is_array() && value.size() > 1 && (value[0].is_string() || value[0].is_object());
}

}  // namespace

std::string to_text(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void print_report(Console& console, const Json& report) {
    if (console.json()) return console.result(to_text(report) + "\n");
    size_t width = 0;
    for (const auto& [key, value] : report.items()) width = std::max(width, key.size());
    std::string text;
    for (const auto& [key, value] : report.items()) {
        if (value.is_structured() && value.empty()) continue;
        std::string label = key;
        std::replace(label.begin(), label.end(), '_', ' ');
        const Json rows = many_lines(value) ? value : Json::array({value});
        for (const Json& row : rows) {
            text += fmt::format("{:<{}}  {}\n", label, width, line_of(row));
            label.clear();
        }
    }
    console.result(text);
}

Json names(const std::vector<std::filesystem::path>& paths) {
    Json list = Json::array();
    for (const std::filesystem::path& path : paths) list.push_back(path.string());
    return list;
}

double rounded_seconds(double seconds) { return std::round(seconds * 1e3) / 1e3; }

}  // namespace aglow::cli
