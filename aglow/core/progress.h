// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <string_view>

namespace aglow {

/// How long work talks to whoever started it. Both members may be empty: then the work runs
/// silently and to its end.
struct Monitor {
    /// Called now and then, possibly from several threads, with 0 <= fraction <= 1 of `stage`.
    std::function<void(std::string_view stage, double fraction)> report = {};
    /// Work polls this and ends with Errc::cancelled once it is true.
    const std::atomic<bool>* cancel = nullptr;

    void operator()(std::string_view stage, double fraction) const {
        if (report) report(stage, fraction);
    }
    bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

}  // namespace aglow
