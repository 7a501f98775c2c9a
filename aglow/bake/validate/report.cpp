// SPDX-License-Identifier: Apache-2.0
// Three ways to write the table of analytic cases: for a terminal, for programs, for docs/.
#include "aglow/bake/validate.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

size_t failed_count(const std::vector<ValidationCase>& cases) {
    return static_cast<size_t>(std::count_if(cases.begin(), cases.end(),
                                             [](const ValidationCase& c) { return !c.passed(); }));
}

double worst_error(const std::vector<ValidationCase>& cases) {
    double worst = 0;
    for (const ValidationCase& c : cases)
        if (!(std::fabs(c.error) <= worst)) worst = std::fabs(c.error);
    return worst;
}

std::string scale_name(double scale) {
    if (scale == 0.001) return "mm";
    if (scale == 1) return "m";
    if (scale == 1000) return "km";
    return fmt::format("x {:g}", scale);
}

std::string percent(double ratio) { return fmt::format("{:+.3f} %", 100 * ratio); }

std::string title(const ValidationCase& c) { return c.group + ", " + c.name + ": " + c.quantity; }

std::string summary(const std::vector<ValidationCase>& cases) {
    return fmt::format("{} of {} cases within their bounds; largest error {:.3f} %",
                       cases.size() - failed_count(cases), cases.size(), 100 * worst_error(cases));
}

/// Cases of one quantity at all scales stand side by side.
bool same_quantity(const ValidationCase& a, const ValidationCase& b) {
    return a.group == b.group && a.name == b.name && a.quantity == b.quantity;
}

std::string markdown_row(const std::vector<ValidationCase>& cases, size_t first, size_t end) {
    const ValidationCase& c = cases[first];
    std::string row = fmt::format("| {} | {} | {} | {:.6g} {} |", c.name, c.quantity, c.source,
                                  c.expected, c.unit);
    for (size_t i = first; i < end; ++i) {
        row += fmt::format(" {:.6g} | {}{} |", cases[i].measured, percent(cases[i].error),
                           cases[i].passed() ? "" : " **beyond**");
    }
    return row + "\n";
}

std::string markdown_head(const std::vector<ValidationCase>& cases, size_t first, size_t end) {
    std::string head = fmt::format(
        "\n## {}\n\n| scene | quantity | expected value from | expected |", cases[first].group);
    std::string rule = "\n|---|---|---|---|";
    for (size_t i = first; i < end; ++i) {
        head += fmt::format(" {} | error |", scale_name(cases[i].scale));
        rule += "---|---|";
    }
    return head + rule + "\n";
}

}  // namespace

std::string validation_table(const std::vector<ValidationCase>& cases) {
    size_t width = 0;
    for (const ValidationCase& c : cases) width = std::max(width, title(c).size());
    std::string text = fmt::format("{:<{}}  {:>5}  {:>11}  {:>11}      {:>10}\n", "case", width,
                                   "scale", "expected", "measured", "error");
    for (const ValidationCase& c : cases)
        text += fmt::format("{:<{}}  {:>5}  {:>11.6g}  {:>11.6g} {}  {:>10}{}\n", title(c), width,
                            scale_name(c.scale), c.expected, c.measured, c.unit, percent(c.error),
                            c.passed() ? "" : "  BEYOND " + percent(c.tolerance).substr(1));
    return text + summary(cases) + "\n";
}

std::string validation_json(const std::vector<ValidationCase>& cases) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ValidationCase& c : cases)
        list.push_back({{"group", c.group},
                        {"name", c.name},
                        {"quantity", c.quantity},
                        {"unit", c.unit},
                        {"source", c.source},
                        {"scale", c.scale},
                        {"expected", c.expected},
                        {"measured", c.measured},
                        {"error", c.error},
                        {"tolerance", c.tolerance},
                        {"seconds", c.seconds},
                        {"passed", c.passed()}});
    nlohmann::ordered_json whole;
    whole["passed"] = failed_count(cases) == 0;
    whole["failed"] = failed_count(cases);
    whole["worst_error"] = worst_error(cases);
    whole["cases"] = std::move(list);
    return whole.dump(2);
}

std::string validation_markdown(const std::vector<ValidationCase>& cases,
                                const ValidationRun& run) {
    constexpr const char* kQualities[] = {"draft", "medium", "high"};
    std::string text = fmt::format(
        "# Validation\n\n"
        "Every analytic case, measured through `bake` and `measure` at millimetres, metres and\n"
        "kilometres (light scaled along), beside the value that theory gives.\n\n"
        "- command: `{}`\n- date: {}\n- device: {}\n- method: {}, quality: {}\n"
        "- bound: {:g} % (draft {:g} %, medium {:g} %, high {:g} %); 0 exactly where no light can "
        "arrive\n- result: {}\n",
        run.command, run.date, run.device, run.method == Method::gather ? "gather" : "path",
        kQualities[static_cast<size_t>(run.quality)], 100 * validation_tolerance(run.quality),
        100 * validation_tolerance(Quality::draft), 100 * validation_tolerance(Quality::medium),
        100 * validation_tolerance(Quality::high), summary(cases));
    for (size_t first = 0, end = 0; first < cases.size(); first = end) {
        while (end < cases.size() && same_quantity(cases[first], cases[end])) ++end;
        if (first == 0 || cases[first - 1].group != cases[first].group)
            text += markdown_head(cases, first, end);
        text += markdown_row(cases, first, end);
    }
    return text;
}

}  // namespace aglow
