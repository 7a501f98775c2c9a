// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <mutex>

namespace aglow::vk {

/// How long the groups of a kernel take: their mean over what ran last. Its first run does not
/// count, because drivers may still be compiling then.
/// Thread safety  all members may be called from any thread.
class KernelRate {
public:
    KernelRate() = default;  ///< knows nothing
    /// Assumes a rate until it has measured one.
    explicit KernelRate(double seconds_per_group);

    struct Piece {
        uint64_t groups = 0;           ///< that may run in one piece
        double seconds_per_group = 0;  ///< that they are expected to take
        bool probe = false;            ///< a longer piece may run once this one is measured
    };
    /// A piece that is expected to take `seconds` at most. It is no more than a few times longer
    /// than any that was measured.
    Piece next_piece(double seconds) const;

    /// Learns that `groups` took `seconds`.
    void add(uint64_t groups, double seconds);

private:
    mutable std::mutex mutex_;
    int runs_ = 0;
    uint64_t longest_ = 0;             // groups measured in one piece
    double seconds_ = 0, groups_ = 0;  // sums whose past fades
};

}  // namespace aglow::vk
