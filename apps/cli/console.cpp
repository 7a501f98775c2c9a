// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>

#include <cstdio>

#include <sys/resource.h>
#include <unistd.h>

namespace aglow::cli {
namespace {

ProgressStyle progress_style(const SharedOptions& options) {
    if (options.quiet) return ProgressStyle::none;
    if (isatty(STDERR_FILENO) == 1) return ProgressStyle::line;
    return options.verbose ? ProgressStyle::stages : ProgressStyle::none;
}

Result<std::string> parse_device(const std::string& name) {
    if (name == "auto" || name == "cpu" || name == "gpu") return name;
    if (name.starts_with("gpu:") && name.size() > 4) return name;
    return fail(Errc::bad_argument,
                fmt::format("\"{}\" is none of: auto, cpu, gpu, gpu:NAME", name));
}

}  // namespace

Table shared_table(SharedOptions& o) {
    constexpr int kMostThreads = 4096;
    return {
        {"--device", parsed(&o.device, parse_device), "NAME",
         "auto (default), cpu, gpu or gpu:NAME; a GPU can do `aglow render`"},
        {"--threads", whole(&o.threads, 0, kMostThreads), "N",
         "threads to use; 0 (default): one for each core"},
        {"--seed", seed(&o.seed), "N", "seed of all random numbers (default 0)"},
        {"--json", flag(&o.json), "", "print one JSON object"},
        {"--quiet", flag(&o.quiet), "", "no progress and no warnings"},
        {"--verbose", flag(&o.verbose), "", "say on stderr what is being done"},
    };
}

Status check(const SharedOptions& options) {
    if (options.quiet && options.verbose)
        return fail(Errc::bad_argument,
                    "--quiet and --verbose contradict each other; give one of them");
    return {};
}

Console::Console(const SharedOptions& options, const std::atomic<bool>& interrupted)
    : options_(options), interrupted_(interrupted), progress_(progress_style(options)) {}

Monitor Console::monitor() {
    return {.report = [this](std::string_view stage,
                             double fraction) { progress_.report(stage, fraction); },
            .cancel = &interrupted_};
}

Status Console::go_on(std::string_view stage) {
    if (interrupted_) return fail(Errc::cancelled, "interrupted");
    progress_.report(stage, 0);
    return {};
}

void Console::warn(const std::string& message) {
    if (options_.quiet) return;
    progress_.clear();
    fmt::print(stderr, "warning: {}\n", message);
}

void Console::note(const std::string& message) {
    if (!options_.verbose) return;
    progress_.clear();
    fmt::print(stderr, "{}\n", message);
}

void Console::result(const std::string& text) {
    progress_.clear();
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

uint64_t peak_memory_bytes() {
    constexpr uint64_t kUnit = 1024;  // Linux counts ru_maxrss in KiB
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * kUnit;
}

}  // namespace aglow::cli
