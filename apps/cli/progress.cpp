// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace aglow::cli {
namespace {

constexpr double kSecondsBetweenUpdates = 0.1;
constexpr double kSecondsBeforeEstimate = 1;  // an earlier one jumps about
constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

std::string duration(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const long long whole = std::llround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

void Progress::begin(std::string_view stage, Clock::time_point now) {
    stage_ = stage;
    stage_start_ = now;
    last_shown_ = {};
    if (style_ == ProgressStyle::stages) fmt::print(stderr, "{} ...\n", stage);
}

void Progress::report(std::string_view stage, double fraction) {
    if (style_ == ProgressStyle::none) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (stage != stage_) begin(stage, now);
    const auto since = [&](Clock::time_point then) {
        return std::chrono::duration<double>(now - then).count();
    };
    if (style_ != ProgressStyle::line || since(last_shown_) < kSecondsBetweenUpdates) return;

    const double done = std::clamp(fraction, 0.0, 1.0);
    const double elapsed = since(stage_start_);
    std::string line = fmt::format("{}{} {:3.0f} %", kEraseLine, stage, 100 * done);
    if (done > 0 && done < 1 && elapsed > kSecondsBeforeEstimate)
        line += fmt::format(", {} left", duration(elapsed * (1 - done) / done));
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
    last_shown_ = now;
    visible_ = true;
}

void Progress::clear() {
    const std::lock_guard lock(mutex_);
    if (visible_) std::fputs(kEraseLine, stderr);
    visible_ = false;
}

}  // namespace aglow::cli
