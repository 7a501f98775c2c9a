// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace aglow::cli {

/// How progress is shown on stderr.
enum class ProgressStyle {
    none,
    line,   ///< one line that is rewritten: for a terminal
    stages  ///< one line for each stage that starts: for a log
};

/// Shows what is being worked on and how long it will still take. Thread-safe.
class Progress {
public:
    explicit Progress(ProgressStyle style) : style_(style) {}
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `fraction` of `stage` is done.
    void report(std::string_view stage, double fraction);
    /// Takes the line away, so that other text can be printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    void begin(std::string_view stage, Clock::time_point now);

    ProgressStyle style_;
    std::mutex mutex_;
    std::string stage_;
    Clock::time_point stage_start_;
    Clock::time_point last_shown_;
    bool visible_ = false;
};

/// "0.4 s", "12 s", "3 min 20 s", "2 h 5 min".
std::string duration(double seconds);

}  // namespace aglow::cli
