// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/kernel_rate.h"

#include <algorithm>
#include <cmath>

namespace aglow::vk {

namespace {

constexpr uint64_t kFirstGroups = 16;     // of a kernel of which nothing is known ...
constexpr double kFirstSeconds = 100e-6;  // ... and what each is taken for
constexpr uint64_t kGrowth = 16;          // of a piece over the longest that was measured
constexpr double kMemorySeconds = 0.01;   // work after which the past counts 1/e

}  // namespace

KernelRate::KernelRate(double seconds_per_group)
    : runs_(1), longest_(UINT64_MAX / kGrowth), seconds_(seconds_per_group), groups_(1) {}

KernelRate::Piece KernelRate::next_piece(double seconds) const {
    std::lock_guard lock(mutex_);
    if (groups_ == 0) return {kFirstGroups, kFirstSeconds, true};
    double rate = std::max(seconds_ / groups_, 1e-12);
    double fitting = std::clamp(std::floor(seconds / rate), 1.0, 1e18);
    uint64_t grown = longest_ * kGrowth;
    uint64_t groups = std::min(static_cast<uint64_t>(fitting), grown);
    return {groups, rate, groups == grown};
}

void KernelRate::add(uint64_t groups, double seconds) {
    std::lock_guard lock(mutex_);
    if (runs_++ == 0 || groups == 0) return;
    // The past fades with the longer of what was expected and what was seen, so that both a rate
    // that was too high and one that was too low are soon forgotten, while many short runs, which
    // mostly show the cost of starting them, say little about the long ones.
    double count = static_cast<double>(groups);
    double expected = groups_ > 0 ? count * seconds_ / groups_ : 0;
    double fade = std::exp(-std::max(seconds, expected) / kMemorySeconds);
    seconds_ = seconds_ * fade + seconds;
    groups_ = groups_ * fade + count;
    longest_ = std::max(longest_, groups);
}

}  // namespace aglow::vk
