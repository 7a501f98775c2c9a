// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/stream.h"

#include "aglow/core/assert.h"
#include "aglow/vk/device.h"
#include "aglow/vk/stream_state.h"

#include <algorithm>
#include <array>
#include <optional>

namespace aglow::vk {

namespace {

constexpr uint64_t kUploadChunk = kUploadRing / 4;
constexpr uint64_t kReadbackChunk = uint64_t{4} << 20;

}  // namespace

Status Stream::State::reserve(Buffer& buffer, uint64_t bytes, std::string_view name,
                              Memory memory) {
    if (recorder->failure()) return tl::unexpected(*recorder->failure());
    if (buffer.size() > 0) return {};
    auto made = gpu->make_buffer(bytes, name, memory);
    if (!made) {
        recorder->fail_with(made.error());
        return tl::unexpected(std::move(made).error());
    }
    buffer = std::move(*made);
    return {};
}

/// Copies `data` to the upload ring, for room in which it may wait.
std::optional<uint64_t> Stream::State::stage(std::span<const std::byte> data) {
    if (!reserve(upload_buffer, kUploadRing, "upload staging", Memory::upload)) return {};
    upload_ring.release_until(recorder->finished_batch());
    std::optional<uint64_t> offset = upload_ring.allocate(data.size());
    while (!offset) {
        uint64_t oldest = upload_ring.oldest_batch().value_or(0);
        if (oldest == recorder->current_batch()) recorder->submit();
        recorder->wait(oldest);
        if (recorder->failure()) return {};
        upload_ring.release_until(recorder->finished_batch());
        offset = upload_ring.allocate(data.size());
    }
    std::memcpy(static_cast<std::byte*>(upload_buffer.mapped()) + *offset, data.data(),
                data.size());
    return offset;
}

template <class Done>
void Stream::State::copy(VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset,
                         uint64_t bytes, Done done) {
    auto record = [&](RecordTarget& target, uint64_t first, uint64_t count) {
        uint64_t start = first * kCopyUnit;
        VkBufferCopy region{from_offset + start, to_offset + start,
                            std::min(count * kCopyUnit, bytes - start)};
        vkCmdCopyBuffer(target.commands, from, to, 1, &region);
        done();
    };
    recorder->run({"copy", copy_rate, group_count(bytes, kCopyUnit)}, record);
}

Stream::Stream(std::unique_ptr<State> state) : state_(std::move(state)) {}
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;
Stream::~Stream() = default;

Result<Stream> Stream::create(const Gpu& gpu) {
    auto state = std::make_unique<State>(gpu);
    AG_TRY(state->recorder, Recorder::create(gpu));
    return Stream(std::move(state));
}

const Gpu& Stream::gpu() const { return state_->gpu; }

Result<Buffer> Stream::make_buffer(uint64_t bytes, std::string_view name, Memory memory) {
    return gpu()->make_buffer(bytes, name, memory);
}

void Stream::run_bytes(const Kernel& kernel, std::span<const std::byte> args, uint64_t groups) {
    AG_ASSERT(groups <= UINT32_MAX, "first_group has 32 bits");
    std::array<std::byte, 128> push;
    std::copy(args.begin(), args.end(), push.begin());
    auto record = [&](RecordTarget& target, uint64_t first, uint64_t count) {
        uint32_t first_group = static_cast<uint32_t>(first);
        std::memcpy(push.data(), &first_group, sizeof first_group);
        if (target.bound != kernel.pipeline()) {
            vkCmdBindPipeline(target.commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
            target.bound = kernel.pipeline();
        }
        vkCmdPushConstants(target.commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<uint32_t>(args.size()), push.data());
        vkCmdDispatch(target.commands, static_cast<uint32_t>(count), 1, 1);
    };
    state_->recorder->run({kernel.name(), kernel.rate(), groups}, record);
}

void Stream::barrier() { state_->recorder->barrier(); }

void Stream::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
    AG_ASSERT(offset % 4 == 0 && bytes % 4 == 0, "fills are of whole words");
    AG_ASSERT(offset + bytes <= buffer.size(), "fills stay in the buffer");
    auto record = [&](RecordTarget& target, uint64_t first, uint64_t count) {
        uint64_t start = first * kCopyUnit;
        vkCmdFillBuffer(target.commands, buffer.get(), offset + start,
                        std::min(count * kCopyUnit, bytes - start), value);
    };
    state_->recorder->run({"fill", state_->fill_rate, group_count(bytes, kCopyUnit)}, record);
}

void Stream::copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset,
                  uint64_t bytes) {
    AG_ASSERT(from_offset + bytes <= from.size() && to_offset + bytes <= to.size(),
              "copies stay in their buffers");
    state_->copy(from.get(), from_offset, to.get(), to_offset, bytes, [] {});
}

void Stream::upload_bytes(std::span<const std::byte> data, const Buffer& to, uint64_t to_offset) {
    AG_ASSERT(to_offset + data.size() <= to.size(), "uploads stay in the buffer");
    State& state = *state_;
    auto staged = [&] { state.upload_ring.used_by(state.recorder->current_batch()); };
    for (uint64_t start = 0; start < data.size(); start += kUploadChunk) {
        std::span chunk = data.subspan(start, std::min(kUploadChunk, data.size() - start));
        std::optional<uint64_t> offset = state.stage(chunk);
        if (!offset) return;
        state.copy(state.upload_buffer.get(), *offset, to.get(), to_offset + start, chunk.size(),
                   staged);
        // A full chunk is on its way while the next is copied to the ring.
        if (chunk.size() == kUploadChunk) state.recorder->submit();
    }
}

void Stream::submit() { state_->recorder->submit(); }

Status Stream::finish() {
    state_->recorder->finish();
    if (state_->recorder->failure()) return tl::unexpected(*state_->recorder->failure());
    return {};
}

Status Stream::download_bytes(const Buffer& from, uint64_t from_offset, std::span<std::byte> to) {
    AG_ASSERT(from_offset + to.size() <= from.size(), "downloads stay in the buffer");
    State& state = *state_;
    Recorder& recorder = *state.recorder;
    AG_CHECK(state.reserve(state.readback_buffer, 2 * kReadbackChunk, "readback staging",
                           Memory::readback));
    recorder.barrier();
    // The device fills one half of the staging memory while the other half is read.
    const std::byte* staging = static_cast<const std::byte*>(state.readback_buffer.mapped());
    std::span<std::byte> chunk;  // that is on its way ...
    uint64_t batch = 0;          // ... in this batch
    for (uint64_t start = 0; start < to.size() + kReadbackChunk; start += kReadbackChunk) {
        std::span<std::byte> waiting = std::exchange(chunk, {});
        uint64_t waiting_batch = batch;
        uint64_t half = start / kReadbackChunk % 2 * kReadbackChunk;
        if (start < to.size()) {
            chunk = to.subspan(start, std::min(kReadbackChunk, to.size() - start));
            state.copy(from.get(), from_offset + start, state.readback_buffer.get(), half,
                       chunk.size(), [] {});
            recorder.barrier();
            batch = recorder.current_batch();
            recorder.submit();
        }
        if (recorder.failure() || waiting.empty()) continue;
        recorder.wait(waiting_batch);
        if (recorder.failure()) continue;
        std::memcpy(waiting.data(), staging + (kReadbackChunk - half), waiting.size());
    }
    return finish();
}

void Stream::label(std::string_view label) { state_->recorder->timings().set_label(label); }

std::vector<Timing> Stream::take_timings() { return state_->recorder->timings().take(); }

std::vector<double> Stream::take_submit_seconds() {
    return state_->recorder->take_submit_seconds();
}

}  // namespace aglow::vk
