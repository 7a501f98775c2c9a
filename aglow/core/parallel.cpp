// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace aglow {

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    const size_t range_count = (count + grain - 1) / grain;
    tbb::parallel_for(size_t{0}, range_count, [&](size_t range) {
        body(range * grain, std::min(count, (range + 1) * grain));
    });
}

// Constructed in place: a copy of a global_control is not registered, and the original's end would
// lift the limit.
struct ThreadLimit::Control {
    explicit Control(size_t threads)
        : limit(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(std::make_unique<Control>(
          static_cast<size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace aglow
