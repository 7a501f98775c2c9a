// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace aglow {

/// Calls body(begin, end) over disjoint ranges that cover [0, count), on all threads allowed.
/// Ranges hold `grain` items (the last may hold fewer), whatever the number of threads: a body
/// that writes only to its own items gives the same bits for any thread count.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

/// Bounds the threads that parallel work of this process uses, for as long as it lives.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);  ///< 0: as many as there are cores
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Control;
    std::unique_ptr<Control> control_;
};

}  // namespace aglow
