// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "console.h"
#include "options.h"

#include <functional>
#include <memory>
#include <string>

namespace aglow::cli {

inline constexpr int kExitDone = 0;
inline constexpr int kExitDiffers = 7;  ///< a compared difference exceeds its bound

/// A subcommand: its interface as a table, and what it does.
struct Command {
    std::string name;
    std::string usage;    ///< arguments after the name, for the first line of --help
    std::string summary;  ///< one sentence
    Table table;
    bool on_gpu = false;                       ///< --device gpu makes sense
    std::function<Result<int>(Console&)> run;  ///< an exit code, or why there is none
};

/// Binds a table and a function to an options value that lives as long as the command.
template <class Options>
Command command(std::string name, std::string usage, std::string summary, Table (*table)(Options&),
                Result<int> (*run)(const Options&, Console&)) {
    auto options = std::make_shared<Options>();
    return {std::move(name),
            std::move(usage),
            std::move(summary),
            table(*options),
            false,
            [options, run](Console& console) { return run(*options, console); }};
}

Command bake_command();
Command bench_command();
Command compare_command();
Command info_command();
Command measure_command();
Command refine_command();
Command render_command();
Command scene_command();
Command simplify_command();
Command validate_command();

}  // namespace aglow::cli
