// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/handle.h"
#include "aglow/vk/kernel_rate.h"
#include "aglow/vk/timing_table.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aglow::vk {

/// Where work is recorded.
struct RecordTarget {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkPipeline bound = VK_NULL_HANDLE;              ///< the pipeline that it has bound last
    VkImageView drawing = VK_NULL_HANDLE;           ///< what is being drawn into
    PFN_vkCmdEndRendering end_rendering = nullptr;  ///< null where the device cannot draw

    /// What is recorded next does not draw, or not into this.
    void end_drawing() {
        if (drawing) end_rendering(commands);
        drawing = VK_NULL_HANDLE;
    }
};

/// What is recorded in pieces.
struct Work {
    std::string_view name;
    const std::shared_ptr<KernelRate>& rate;
    uint64_t groups = 0;
    uint64_t grain = 1;     ///< pieces are a multiple of it
    uint64_t most = 65535;  ///< groups of a piece
    bool draws = false;     ///< it may follow what draws without an end to that
};

/// Records work into command buffers ("batches") and submits these so that each is expected to take
/// 50 ms at most. Keeps the first failure; from then on nothing is recorded.
/// Thread safety  one thread at a time.
class Recorder {
public:
    static Result<std::unique_ptr<Recorder>> create(const Gpu& gpu);
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;
    ~Recorder();  ///< waits for what was submitted

    /// Records work in pieces: record(target, first, count).
    template <class Record>
    void run(const Work& work, Record record);
    void barrier();  ///< see Stream
    void submit();   ///< what is recorded, if anything is
    void wait(uint64_t batch);
    void finish();  ///< submits all and waits for it
    void fail_with(Error error);

    uint64_t current_batch() const { return next_; }       ///< being recorded, or next to be
    uint64_t finished_batch() const { return finished_; }  ///< all up to this one have finished
    const std::optional<Error>& failure() const { return failure_; }
    const Gpu& gpu() const { return gpu_; }
    TimingTable& timings() { return timings_; }
    std::vector<double> take_submit_seconds() { return std::exchange(submit_seconds_, {}); }

private:
    using Clock = std::chrono::steady_clock;
    struct Entry {
        uint32_t row = 0;
        KernelRate* rate = nullptr;
        uint64_t groups = 0;
        double expected = 0;  // seconds
        bool first = false;   // piece of its dispatch
    };
    struct Batch {
        RecordTarget target;
        QueryPool queries;  // time stamps before and after each entry
        std::vector<Entry> entries;
        uint64_t number = 0;  // of the batch in the stream, from 1
        uint64_t ticket = 0;  // what Device::submit() gave
        bool recording = false;
        double expected = 0;  // seconds
        Clock::time_point submitted;
    };
    static constexpr double kSubmitSeconds = 0.05;  // twice as slow is still below 100 ms
    static constexpr size_t kBatches = 4;           // in flight
    static constexpr uint32_t kBatchEntries = 512;

    explicit Recorder(const Gpu& gpu) : gpu_(gpu) {}
    Status make_objects();
    Batch& slot(uint64_t number) { return batches_[number % kBatches]; }
    bool begin(double expected);
    bool start(Batch& batch);
    void add_entry(const Entry& entry);
    void collect(Batch& batch);
    std::vector<double> entry_seconds(const Batch& batch);
    std::vector<double> host_seconds(const Batch& batch);
    std::string describe(const Batch& batch) const;

    Gpu gpu_;
    CommandPool pool_;
    std::array<Batch, kBatches> batches_;
    uint64_t next_ = 1;  // number of the batch that is recorded, or will be
    uint64_t finished_ = 0;
    bool unordered_ = false;  // work was recorded after the last barrier
    std::optional<Error> failure_;
    TimingTable timings_;
    std::vector<double> submit_seconds_;
    Clock::time_point idle_since_;
};

template <class Record>
void Recorder::run(const Work& work, Record record) {
    uint32_t row = timings_.row(work.rate, work.name);
    for (uint64_t first = 0; first < work.groups;) {
        KernelRate::Piece piece = work.rate->next_piece(kSubmitSeconds);
        uint64_t fitting = std::max(std::min(piece.groups, work.most) / work.grain, uint64_t{1});
        uint64_t count = std::min(work.groups - first, fitting * work.grain);
        double expected = static_cast<double>(count) * piece.seconds_per_group;
        if (!begin(expected)) return;
        if (!work.draws) slot(next_).target.end_drawing();
        record(slot(next_).target, first, count);
        add_entry({row, work.rate.get(), count, expected, first == 0});
        first += count;
        if (first == work.groups || !piece.probe || count + work.grain <= piece.groups) continue;
        submit();
        if (!failure_) wait(next_ - 1);
    }
}

}  // namespace aglow::vk
