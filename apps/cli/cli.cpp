// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

#include "aglow/core/parallel.h"
#include "command.h"
#include "interrupt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <new>

namespace aglow::cli {
namespace {

std::vector<Command> commands() {
    return {bake_command(),    render_command(),  refine_command(),   simplify_command(),
            measure_command(), compare_command(), validate_command(), bench_command(),
            scene_command(),   info_command()};
}

int exit_code(Errc code) {
    switch (code) {
        case Errc::bad_argument:
            return 1;
        case Errc::unreadable:
            return 2;
        case Errc::malformed:
            return 3;
        case Errc::out_of_memory:
        case Errc::device_lost:
            return 4;
        case Errc::unsupported:
            return 5;
        case Errc::cancelled:
            return 130;
    }
    return 4;
}

int report(const std::string& who, const Error& error) {
    fmt::print(stderr, "{}: {}\n", who, to_string(error));
    return exit_code(error.code);
}

std::string overview() {
    std::string text =
        "Usage: aglow COMMAND ... [options]\n\n"
        "Bakes diffuse global illumination for glTF scenes, in lux.\n\nCommands:\n";
    for (const Command& command : commands())
        text += fmt::format("  {:<9} {}\n", command.name, command.summary);
    return text +
           "\n`aglow COMMAND --help` shows a command's options, `aglow --version` the version.\n";
}

std::string help(const Command& command, const Table& table) {
    std::string summary = command.summary;
    summary.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(summary.front())));
    return fmt::format("Usage: aglow {} {}\n\n{}.\n\n{}", command.name, command.usage, summary,
                       describe(table));
}

int run_command(Command& command, const std::vector<std::string>& arguments,
                const Interrupt& interrupt) {
    const std::string who = "aglow " + command.name;
    SharedOptions shared;
    bool help_wanted = false;
    Table table = command.table;
    table += shared_table(shared);
    table += {{"-h,--help", flag(&help_wanted), "", "print this text"}};
    if (std::any_of(arguments.begin(), arguments.end(),
                    [](const std::string& word) { return word == "--help" || word == "-h"; })) {
        fmt::print("{}", help(command, table));
        return kExitDone;
    }
    Status parsed = parse(table, arguments);
    if (parsed) parsed = check(shared);
    if (parsed && !command.on_gpu && shared.device.starts_with("gpu"))
        parsed =
            fail(Errc::unsupported, fmt::format("`{}` runs on the CPU; use --device cpu", who));
    if (!parsed) {
        const int code = report(who, parsed.error());
        if (code == 1) fmt::print(stderr, "`{} --help` shows the options\n", who);
        return code;
    }
    const ThreadLimit limit(shared.threads);
    Console console(shared, interrupt.flag());
    const Result<int> result = command.run(console);
    return result ? *result : report(who, result.error());
}

int dispatch(const std::vector<std::string>& words, const Interrupt& interrupt) {
    if (words.empty()) {
        fmt::print(stderr, "{}", overview());
        return exit_code(Errc::bad_argument);
    }
    if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
        fmt::print("{}", overview());
        return kExitDone;
    }
    if (words[0] == "--version") {
        fmt::print("aglow {}\n", AGLOW_VERSION);
        return kExitDone;
    }
    for (Command& command : commands())
        if (command.name == words[0])
            return run_command(command, {words.begin() + 1, words.end()}, interrupt);
    std::vector<std::string> names;
    for (const Command& command : commands()) names.push_back(command.name);
    return report("aglow", no_such_choice(words[0], names, {"view", "web"}).value());
}

}  // namespace

int run(const std::vector<std::string>& words) {
    try {
        const Interrupt interrupt;
        return dispatch(words, interrupt);
    } catch (const std::bad_alloc&) {
        return report("aglow", {Errc::out_of_memory,
                                "memory ran out; a larger --texel-size, a smaller --resolution or "
                                "fewer sensors need less"});
    } catch (const std::exception& error) {
        return report("aglow", {Errc::device_lost, error.what()});
    }
}

}  // namespace aglow::cli
