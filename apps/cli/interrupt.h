// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <thread>

namespace aglow::cli {

/// Turns SIGINT and SIGTERM into a flag that long work polls. A second signal ends the process at
/// once with exit code 130.
///
/// Create it before any other thread starts: threads inherit that the signals are blocked, so that
/// only the thread of this object takes them.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const std::atomic<bool>& flag() const { return asked_; }

private:
    void wait_for_signals();

    std::atomic<bool> asked_ = false;
    std::atomic<bool> ended_ = false;
    std::thread waiter_;
};

}  // namespace aglow::cli
