// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "options.h"
#include "progress.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aglow::cli {

/// What every command understands.
struct SharedOptions {
    std::string device = "auto";  ///< "auto", "cpu", "gpu" or "gpu:NAME"
    int threads = 0;              ///< 0: as many as there are cores
    uint64_t seed = 0;
    bool json = false;
    bool quiet = false;
    bool verbose = false;
};

Table shared_table(SharedOptions& options);
/// Errors  bad_argument  options that contradict each other.
Status check(const SharedOptions& options);

/// How a command talks: results go to stdout, everything else to stderr.
class Console {
public:
    Console(const SharedOptions& options, const std::atomic<bool>& interrupted);

    const SharedOptions& options() const { return options_; }
    bool json() const { return options_.json; }
    /// For long work: shows progress, and stops the work when the user asks for it.
    Monitor monitor();
    /// Errors  cancelled  the user has asked to stop; for stages that poll no monitor.
    Status go_on(std::string_view stage);

    void warn(const std::string& message);  ///< unless --quiet
    void note(const std::string& message);  ///< only with --verbose
    void result(const std::string& text);   ///< to stdout, as it is

private:
    SharedOptions options_;
    const std::atomic<bool>& interrupted_;
    Progress progress_;
};

/// Seconds since it was made.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Largest amount of memory this process has held, bytes.
uint64_t peak_memory_bytes();

}  // namespace aglow::cli
