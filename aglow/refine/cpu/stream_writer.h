// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace aglow::refine::cpu {

/// Writes floats one after the other past the caches: what it replaces is not read, and what is
/// read elsewhere stays cached. For results far larger than the caches.
class StreamWriter {
public:
    static constexpr size_t kMostRoom = 2048;  ///< floats

    explicit StreamWriter(float* to)
        : to_(to), used_((reinterpret_cast<std::uintptr_t>(to) / sizeof(float)) % kLine) {
        skipped_ = used_;
    }
    StreamWriter(const StreamWriter&) = delete;
    StreamWriter& operator=(const StreamWriter&) = delete;
    ~StreamWriter() {
        flush();
        std::memcpy(to_, staging_ + skipped_, (used_ - skipped_) * sizeof(float));
#if defined(__SSE2__)
        _mm_sfence();
#endif
    }

    /// Where the next floats go: kMostRoom of them may be written, and again.
    [[gnu::always_inline]] float* room() {
        if (used_ > kCapacity) flush();
        return staging_ + used_;
    }
    void commit(size_t count) { used_ += count; }  ///< keeps the first `count`, <= kMostRoom

private:
    static constexpr size_t kLine = 16;  // floats of a cache line
    // Few, so that the processor computes the next row while lines are on their way.
    static constexpr size_t kCapacity = 64;

    /// Sends whole lines; what begins or ends within one goes the usual way, since the rest of that
    /// line may be another thread's.
    [[gnu::always_inline]] void flush() {
        const size_t whole = used_ / kLine * kLine;
        size_t i = 0;
        if (skipped_ > 0 && whole > 0) {
            std::memcpy(to_, staging_ + skipped_, (kLine - skipped_) * sizeof(float));
            to_ += kLine - skipped_;
            i = kLine;
            skipped_ = 0;
        }
        if (i < whole) {
            stream(staging_ + i, whole - i);
            to_ += whole - i;
        }
        if (whole == 0) return;
        std::memmove(staging_, staging_ + whole, kLine * sizeof(float));
        used_ -= whole;
    }

    [[gnu::always_inline]] void stream(const float* from, size_t count) {
        float* const to = to_;
#if defined(__SSE2__)
        for (size_t i = 0; i < count; i += 4) _mm_stream_ps(to + i, _mm_load_ps(from + i));
#else
        std::memcpy(to, from, count * sizeof(float));
#endif
    }

    alignas(64) float staging_[kCapacity + kMostRoom + 2 * kLine];
    float* to_;
    size_t used_;
    size_t skipped_;  // floats of the first line that are another's
};

}  // namespace aglow::refine::cpu
