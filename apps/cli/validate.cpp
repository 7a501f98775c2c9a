// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate.h"

#include "aglow/core/file.h"
#include "command.h"
#include "machine.h"
#include "scene_options.h"
#include "solver_options.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace aglow::cli {
namespace {

struct Options {
    Method method = Method::gather;
    Quality quality = Quality::high;
    std::optional<double> scale;
    std::string filter;
    std::optional<std::filesystem::path> markdown;
};

Table table(Options& o) {
    return {
        {"--method",
         choice<Method>(&o.method, {{"gather", Method::gather}, {"path", Method::path}},
                        {"progressive", "hierarchical"}),
         "NAME", "solver to validate: gather (default) or path"},
        {"--quality",
         choice<Quality>(
             &o.quality,
             {{"draft", Quality::draft}, {"medium", Quality::medium}, {"high", Quality::high}}),
         "NAME", "draft, medium or high (default); the bounds follow it"},
        {"--scale", number_above(&o.scale, 0), "X",
         "only at this scale of all lengths (default: 0.001, 1 and 1000)"},
        {"--filter", text(&o.filter), "TEXT", "only cases whose name contains this"},
        {"--markdown",
         parsed(&o.markdown,
                [](const std::string& text) -> Result<std::filesystem::path> {
                    return std::filesystem::path(text);
                }),
         "OUT.md", "also write the table as a document"},
    };
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    return fmt::format("{:%Y-%m-%d}", utc);
}

std::string command_line(const Options& options) {
    std::string line = "aglow validate";
    if (options.method != Method::gather) line += " --method " + name(options.method);
    if (options.quality != Quality::high) line += " --quality " + name(options.quality);
    if (options.scale) line += fmt::format(" --scale {}", *options.scale);
    if (!options.filter.empty()) line += fmt::format(" --filter \"{}\"", options.filter);
    return line + " --markdown " + options.markdown->string();
}

Result<int> run(const Options& options, Console& console) {
    if (options.markdown) AG_CHECK(check_output(*options.markdown, {".md"}));
    ValidationOptions asked{.method = options.method,
                            .quality = options.quality,
                            .filter = options.filter,
                            .seed = console.options().seed};
    if (options.scale) asked.scales = {*options.scale};
    AG_TRY(const std::vector<ValidationCase> cases, validate(asked, console.monitor()));
    if (options.markdown) {
        const ValidationRun how{.command = command_line(options),
                                .date = today(),
                                .device = processor(console.options().threads),
                                .method = options.method,
                                .quality = options.quality};
        AG_CHECK(write_file(*options.markdown, validation_markdown(cases, how)));
    }
    std::string text = console.json() ? validation_json(cases) : validation_table(cases);
    if (!text.ends_with('\n')) text += '\n';
    console.result(text);
    const bool passed =
        std::all_of(cases.begin(), cases.end(), [](const ValidationCase& c) { return c.passed(); });
    return passed ? kExitDone : kExitDiffers;
}

}  // namespace

Command validate_command() {
    return command("validate", "[options]", "compares computed light with closed forms", table,
                   run);
}

}  // namespace aglow::cli
