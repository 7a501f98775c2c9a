// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/stream.h"

#include "aglow/core/assert.h"
#include "aglow/vk/device.h"
#include "aglow/vk/failure.h"
#include "aglow/vk/kernel_rate.h"
#include "aglow/vk/staging_ring.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>

namespace aglow::vk {

namespace {

constexpr double kSubmitSeconds = 0.05;  // aimed at, so that twice as slow is still below 100 ms
constexpr uint64_t kMaxGroups = 65535;   // in one dispatch
constexpr size_t kBatches = 4;           // in flight
constexpr uint32_t kBatchEntries = 512;  // in one submit
constexpr uint64_t kUploadRing = uint64_t{8} << 20;
constexpr uint64_t kUploadChunk = uint64_t{2} << 20;
constexpr uint64_t kReadbackChunk = uint64_t{4} << 20;
constexpr uint64_t kCopyUnit = uint64_t{64} << 10;        // bytes; the "group" of copies and fills
constexpr double kCopySeconds = double{kCopyUnit} / 1e9;  // until measured: 1 GB/s

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point a, Clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

struct Entry {
    uint32_t row = 0;
    KernelRate* rate = nullptr;
    uint64_t groups = 0;
    double expected = 0;
};

/// One command buffer and what is in it.
struct Batch {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    QueryPool queries;
    std::vector<Entry> entries;
    bool recording = false;
    uint64_t value = 0;  // what it signals; 0: it is not in flight
    double expected = 0;
    uint64_t staged = 0;  // head of the upload ring when it was last used
    VkPipeline bound = VK_NULL_HANDLE;
    Clock::time_point submitted;
};

}  // namespace

struct Stream::State {
    explicit State(const Gpu& its_gpu) : gpu(its_gpu) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Status create();
    Batch* begin(double expected);
    bool start(Batch& batch);
    void submit();
    void wait_for(uint64_t value);
    void collect(Batch& batch);
    std::vector<double> entry_seconds(const Batch& batch);
    std::string describe(const Batch& batch) const;
    uint32_t row_of(const KernelRate* rate, std::string_view kernel);
    void fail_with(Status status);
    void barrier();
    std::optional<uint64_t> stage(uint64_t bytes);
    void record_copy(VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset,
                     uint64_t bytes, bool staged);
    template <class Record>
    void run_pieces(uint32_t row, KernelRate& rate, uint64_t groups, Record record);

    Gpu gpu;
    CommandPool pool;
    Semaphore done;
    std::array<Batch, kBatches> batches;
    size_t current = 0;
    uint64_t last_value = 0;  // submitted
    std::optional<Error> failure;
    bool unordered = false;  // work was recorded after the last barrier

    std::vector<Timing> rows;
    std::string label;
    std::map<std::pair<std::string, const KernelRate*>, uint32_t> known_rows;
    std::vector<double> submit_seconds;
    Clock::time_point idle_since;

    KernelRate copy_rate{kCopySeconds}, fill_rate{kCopySeconds};
    Buffer upload_buffer;
    StagingRing upload_ring{kUploadRing};
    Buffer readback_buffer;
};

Status Stream::State::create() {
    VkDevice device = gpu->get();
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool_info.queueFamilyIndex = gpu->physical().queue_family;
    VkCommandPool pool_handle = VK_NULL_HANDLE;
    VkResult result = vkCreateCommandPool(device, &pool_info, nullptr, &pool_handle);
    if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
    pool = CommandPool(device, pool_handle);

    VkSemaphoreTypeCreateInfo timeline{};
    timeline.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
    timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore_info{};
    semaphore_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    semaphore_info.pNext = &timeline;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    result = vkCreateSemaphore(device, &semaphore_info, nullptr, &semaphore);
    if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
    done = Semaphore(device, semaphore);

    std::array<VkCommandBuffer, kBatches> commands{};
    VkCommandBufferAllocateInfo commands_info{};
    commands_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands_info.commandPool = pool.get();
    commands_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands_info.commandBufferCount = kBatches;
    result = vkAllocateCommandBuffers(device, &commands_info, commands.data());
    if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
    for (size_t i = 0; i < kBatches; ++i) batches[i].commands = commands[i];
    if (gpu->timestamp_period() == 0) return {};

    VkQueryPoolCreateInfo query_info{};
    query_info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    query_info.queryCount = kBatchEntries + 1;
    for (Batch& batch : batches) {
        VkQueryPool queries = VK_NULL_HANDLE;
        result = vkCreateQueryPool(device, &query_info, nullptr, &queries);
        if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
        batch.queries = QueryPool(device, queries);
    }
    return {};
}

Stream::State::~State() {
    if (last_value > 0) wait_for(last_value);
}

void Stream::State::fail_with(Status status) {
    if (!status && !failure) failure = std::move(status).error();
}

std::string Stream::State::describe(const Batch& batch) const {
    auto name = [&](const Entry& entry) {
        const Timing& row = rows[entry.row];
        return row.label.empty() ? fmt::format("\"{}\"", row.kernel)
                                 : fmt::format("\"{}\" of {}", row.kernel, row.label);
    };
    if (batch.entries.empty()) return "nothing";
    std::string first = name(batch.entries.front()), last = name(batch.entries.back());
    return first == last ? first : fmt::format("{} to {}", first, last);
}

uint32_t Stream::State::row_of(const KernelRate* rate, std::string_view kernel) {
    auto [known, is_new] = known_rows.try_emplace({label, rate}, 0u);
    if (!is_new) return known->second;
    auto same = [&](const Timing& row) { return row.label == label && row.kernel == kernel; };
    auto row = std::find_if(rows.begin(), rows.end(), same);
    known->second = static_cast<uint32_t>(row - rows.begin());
    if (row == rows.end()) rows.push_back({label, std::string(kernel), 0, 0});
    return known->second;
}

/// The batch to record into, which has room for work of `expected` seconds; null after a failure.
Batch* Stream::State::begin(double expected) {
    if (failure) return nullptr;
    Batch* batch = &batches[current];
    bool full = batch->entries.size() == kBatchEntries ||
                (!batch->entries.empty() && batch->expected + expected > kSubmitSeconds);
    if (batch->recording && full) {
        submit();
        if (failure) return nullptr;
        batch = &batches[current];
    }
    if (!batch->recording && !start(*batch)) return nullptr;
    return batch;
}

bool Stream::State::start(Batch& batch) {
    if (batch.value > 0) wait_for(batch.value);
    if (failure) return false;
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkResult result = vkBeginCommandBuffer(batch.commands, &info);
    if (result != VK_SUCCESS) {
        fail_with(vk::failure(result, "recording GPU work"));
        return false;
    }
    batch.recording = true;
    batch.expected = 0;
    batch.bound = VK_NULL_HANDLE;
    batch.entries.clear();
    if (batch.queries.get()) {
        vkResetQueryPool(gpu->get(), batch.queries.get(), 0, kBatchEntries + 1);
        vkCmdWriteTimestamp(batch.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            batch.queries.get(), 0);
    }
    return true;
}

void Stream::State::submit() {
    Batch& batch = batches[current];
    if (!batch.recording || failure) return;
    batch.recording = false;
    VkResult result = vkEndCommandBuffer(batch.commands);
    if (result != VK_SUCCESS) return fail_with(vk::failure(result, "recording GPU work"));
    Status status = gpu->submit(batch.commands, done.get(), last_value + 1, describe(batch));
    if (!status) return fail_with(status);
    batch.value = ++last_value;
    batch.submitted = Clock::now();
    current = (current + 1) % kBatches;
}

void Stream::State::wait_for(uint64_t value) {
    std::string what;
    for (const Batch& batch : batches)
        if (batch.value == value) what = describe(batch);
    Status status = gpu->wait(done.get(), value, what);
    if (!status) return fail_with(status);
    for (size_t i = 0; i < kBatches; ++i) {  // from the oldest on
        Batch& batch = batches[(current + i) % kBatches];
        if (batch.value > 0 && batch.value <= value) collect(batch);
    }
}

/// GPU time of each entry of a batch that has finished. Entries may overlap on the device: each
/// counts from the end of the one before it.
std::vector<double> Stream::State::entry_seconds(const Batch& batch) {
    size_t count = batch.entries.size();
    std::vector<double> seconds(count, 0.0);
    if (batch.queries.get()) {
        std::vector<uint64_t> times(count + 1);
        VkResult result = vkGetQueryPoolResults(
            gpu->get(), batch.queries.get(), 0, static_cast<uint32_t>(count + 1),
            times.size() * sizeof(uint64_t), times.data(), sizeof(uint64_t),
            VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (result != VK_SUCCESS) {
            fail_with(vk::failure(result, "reading timestamps"));
            return seconds;
        }
        for (size_t i = 0; i < count; ++i) {
            uint64_t steps = (times[i + 1] - times[i]) & gpu->physical().timestamp_mask;
            seconds[i] = static_cast<double>(steps) * gpu->timestamp_period() * 1e-9;
        }
        return seconds;
    }
    Clock::time_point now = Clock::now();
    double total = seconds_between(std::max(batch.submitted, idle_since), now);
    idle_since = now;
    for (size_t i = 0; i < count; ++i)
        seconds[i] = total * batch.entries[i].expected / batch.expected;
    return seconds;
}

void Stream::State::collect(Batch& batch) {
    std::vector<double> seconds = entry_seconds(batch);
    double total = 0;
    for (size_t i = 0; i < seconds.size(); ++i) {
        const Entry& entry = batch.entries[i];
        rows[entry.row].seconds += seconds[i];
        entry.rate->add(entry.groups, seconds[i]);
        total += seconds[i];
    }
    if (!seconds.empty()) submit_seconds.push_back(total);
    upload_ring.release(batch.staged);
    batch.value = 0;
    batch.entries.clear();
}

/// Records `groups` groups in pieces: record(batch, first, count).
template <class Record>
void Stream::State::run_pieces(uint32_t row, KernelRate& rate, uint64_t groups, Record record) {
    if (groups == 0) return;
    ++rows[row].dispatches;
    for (uint64_t first = 0; first < groups && !failure;) {
        KernelRate::Piece piece = rate.next_piece(kSubmitSeconds);
        uint64_t count = std::min({groups - first, piece.groups, kMaxGroups});
        double expected = static_cast<double>(count) * piece.seconds_per_group;
        Batch* batch = begin(expected);
        if (!batch) return;
        record(*batch, first, count);
        batch->entries.push_back({row, &rate, count, expected});
        batch->expected += expected;
        if (batch->queries.get()) {
            vkCmdWriteTimestamp(batch->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                                batch->queries.get(), static_cast<uint32_t>(batch->entries.size()));
        }
        unordered = true;
        first += count;
        if (first < groups && piece.probe && count == piece.groups) {
            submit();
            if (!failure) wait_for(last_value);
        }
    }
}

void Stream::State::barrier() {
    if (!unordered || failure) return;
    Batch* batch = begin(0);
    if (!batch) return;
    VkMemoryBarrier all{};
    all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    all.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                        VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                        VK_ACCESS_HOST_READ_BIT;
    constexpr VkPipelineStageFlags kDevice =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(batch->commands, kDevice, kDevice | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &all,
                         0, nullptr, 0, nullptr);
    unordered = false;
}

/// Room in the upload ring, for which it may wait.
std::optional<uint64_t> Stream::State::stage(uint64_t bytes) {
    if (failure) return std::nullopt;
    if (upload_buffer.size() == 0) {
        auto buffer = gpu->make_buffer(kUploadRing, "upload staging", Memory::upload);
        if (!buffer) {
            failure = std::move(buffer).error();
            return std::nullopt;
        }
        upload_buffer = std::move(*buffer);
    }
    for (;;) {
        if (auto offset = upload_ring.allocate(bytes)) return offset;
        submit();
        const Batch* oldest = nullptr;
        for (const Batch& batch : batches)
            if (batch.value > 0 && (!oldest || batch.value < oldest->value)) oldest = &batch;
        AG_ASSERT(oldest || failure, "a ring that is full is in use");
        if (failure) return std::nullopt;
        wait_for(oldest->value);
    }
}

void Stream::State::record_copy(VkBuffer from, uint64_t from_offset, VkBuffer to,
                                uint64_t to_offset, uint64_t bytes, bool staged) {
    auto record = [&](Batch& batch, uint64_t first, uint64_t count) {
        uint64_t start = first * kCopyUnit;
        VkBufferCopy region{from_offset + start, to_offset + start,
                            std::min(count * kCopyUnit, bytes - start)};
        vkCmdCopyBuffer(batch.commands, from, to, 1, &region);
        if (staged) batch.staged = upload_ring.head();
    };
    run_pieces(row_of(&copy_rate, "copy"), copy_rate, group_count(bytes, kCopyUnit), record);
}

Stream::Stream(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

Result<Stream> Stream::create(const Gpu& gpu) {
    auto state = std::make_unique<State>(gpu);
    AG_CHECK(state->create());
    return Stream(std::move(state));
}

const Gpu& Stream::gpu() const { return state_->gpu; }

Result<Buffer> Stream::make_buffer(uint64_t bytes, std::string_view name, Memory memory) {
    return state_->gpu->make_buffer(bytes, name, memory);
}

void Stream::run_bytes(const Kernel& kernel, std::span<const std::byte> args, uint64_t groups) {
    AG_ASSERT(groups <= UINT32_MAX, "first_group has 32 bits");
    std::array<std::byte, 128> push;
    std::copy(args.begin(), args.end(), push.begin());
    auto record = [&](Batch& batch, uint64_t first, uint64_t count) {
        uint32_t first_group = static_cast<uint32_t>(first);
        std::memcpy(push.data(), &first_group, sizeof first_group);
        if (batch.bound != kernel.pipeline()) {
            vkCmdBindPipeline(batch.commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
            batch.bound = kernel.pipeline();
        }
        vkCmdPushConstants(batch.commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<uint32_t>(args.size()), push.data());
        vkCmdDispatch(batch.commands, static_cast<uint32_t>(count), 1, 1);
    };
    State& state = *state_;
    state.run_pieces(state.row_of(&kernel.rate(), kernel.name()), kernel.rate(), groups, record);
}

void Stream::barrier() { state_->barrier(); }

void Stream::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
    AG_ASSERT(offset % 4 == 0 && bytes % 4 == 0, "fills are of whole words");
    AG_ASSERT(offset + bytes <= buffer.size(), "fills stay in the buffer");
    auto record = [&](Batch& batch, uint64_t first, uint64_t count) {
        uint64_t start = first * kCopyUnit;
        vkCmdFillBuffer(batch.commands, buffer.get(), offset + start,
                        std::min(count * kCopyUnit, bytes - start), value);
    };
    State& state = *state_;
    state.run_pieces(state.row_of(&state.fill_rate, "fill"), state.fill_rate,
                     group_count(bytes, kCopyUnit), record);
}

void Stream::copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset,
                  uint64_t bytes) {
    AG_ASSERT(from_offset + bytes <= from.size() && to_offset + bytes <= to.size(),
              "copies stay in their buffers");
    state_->record_copy(from.get(), from_offset, to.get(), to_offset, bytes, false);
}

void Stream::upload_bytes(std::span<const std::byte> data, const Buffer& to, uint64_t to_offset) {
    AG_ASSERT(to_offset + data.size() <= to.size(), "uploads stay in the buffer");
    State& state = *state_;
    for (uint64_t start = 0; start < data.size(); start += kUploadChunk) {
        uint64_t bytes = std::min(kUploadChunk, data.size() - start);
        std::optional<uint64_t> staged = state.stage(bytes);
        if (!staged) return;
        std::memcpy(static_cast<std::byte*>(state.upload_buffer.mapped()) + *staged,
                    data.data() + start, bytes);
        state.record_copy(state.upload_buffer.get(), *staged, to.get(), to_offset + start, bytes,
                          true);
    }
}

Status Stream::finish() {
    State& state = *state_;
    state.barrier();  // orders what follows, on the device and here
    state.submit();
    if (state.last_value > 0) state.wait_for(state.last_value);
    state.known_rows.clear();  // kernels may die
    if (state.failure) return tl::unexpected(*state.failure);
    return {};
}

Status Stream::download_bytes(const Buffer& from, uint64_t from_offset, std::span<std::byte> to) {
    AG_ASSERT(from_offset + to.size() <= from.size(), "downloads stay in the buffer");
    State& state = *state_;
    if (state.readback_buffer.size() == 0) {
        AG_TRY(state.readback_buffer,
               state.gpu->make_buffer(2 * kReadbackChunk, "readback staging", Memory::readback));
    }
    state.barrier();
    // One half of the staging memory is filled while the other is read.
    const std::byte* staging = static_cast<const std::byte*>(state.readback_buffer.mapped());
    std::span<std::byte> waiting;
    uint64_t waiting_value = 0;
    for (uint64_t start = 0; start < to.size() + kReadbackChunk; start += kReadbackChunk) {
        uint64_t half = start / kReadbackChunk % 2;
        std::span<std::byte> chunk;
        if (start < to.size()) {
            chunk = to.subspan(start, std::min(kReadbackChunk, to.size() - start));
            state.record_copy(from.get(), from_offset + start, state.readback_buffer.get(),
                              half * kReadbackChunk, chunk.size(), false);
            state.barrier();
            state.submit();
        }
        uint64_t value = state.last_value;
        if (!waiting.empty() && !state.failure) {
            state.wait_for(waiting_value);
            if (!state.failure)
                std::memcpy(waiting.data(), staging + (1 - half) * kReadbackChunk, waiting.size());
        }
        waiting = chunk;
        waiting_value = value;
    }
    return finish();
}

void Stream::label(std::string_view label) { state_->label = label; }

std::vector<Timing> Stream::take_timings() {
    State& state = *state_;
    std::vector<Timing> result = state.rows;
    for (Timing& row : state.rows) row.seconds = 0, row.dispatches = 0;
    std::erase_if(result, [](const Timing& row) { return row.dispatches == 0; });
    return result;
}

std::vector<double> Stream::take_submit_seconds() {
    return std::exchange(state_->submit_seconds, {});
}

}  // namespace aglow::vk
