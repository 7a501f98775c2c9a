// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/recorder.h"

#include "aglow/vk/device.h"
#include "aglow/vk/failure.h"

#include <fmt/format.h>

namespace aglow::vk {

Result<std::unique_ptr<Recorder>> Recorder::create(const Gpu& gpu) {
    std::unique_ptr<Recorder> recorder(new Recorder(gpu));
    AG_CHECK(recorder->make_objects());
    return recorder;
}

Status Recorder::make_objects() {
    VkDevice device = gpu_->get();
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool_info.queueFamilyIndex = gpu_->physical().queue_family;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkResult result = vkCreateCommandPool(device, &pool_info, nullptr, &pool);
    if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
    pool_ = CommandPool(device, pool);

    std::array<VkCommandBuffer, kBatches> commands{};
    VkCommandBufferAllocateInfo commands_info{};
    commands_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands_info.commandPool = pool;
    commands_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands_info.commandBufferCount = kBatches;
    result = vkAllocateCommandBuffers(device, &commands_info, commands.data());
    if (result != VK_SUCCESS) return vk::failure(result, "making a stream");

    VkQueryPoolCreateInfo query_info{};
    query_info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    query_info.queryCount = kBatchEntries + 1;
    for (size_t i = 0; i < kBatches; ++i) {
        batches_[i].target.commands = commands[i];
        batches_[i].target.end_rendering = gpu_->drawing().end;
        if (gpu_->timestamp_period() == 0) continue;
        VkQueryPool queries = VK_NULL_HANDLE;
        result = vkCreateQueryPool(device, &query_info, nullptr, &queries);
        if (result != VK_SUCCESS) return vk::failure(result, "making a stream");
        batches_[i].queries = QueryPool(device, queries);
    }
    return {};
}

Recorder::~Recorder() {
    if (finished_ + 1 < next_) wait(next_ - 1);
}

void Recorder::fail_with(Error error) {
    if (!failure_) failure_ = std::move(error);
}

std::string Recorder::describe(const Batch& batch) const {
    if (batch.entries.empty()) return "a barrier";
    std::string first = timings_.describe(batch.entries.front().row);
    std::string last = timings_.describe(batch.entries.back().row);
    return first == last ? first : fmt::format("{} to {}", first, last);
}

/// Makes the current batch one that has room for work of `expected` seconds.
bool Recorder::begin(double expected) {
    if (failure_) return false;
    const Batch& batch = slot(next_);
    bool full = batch.entries.size() == kBatchEntries ||
                (!batch.entries.empty() && batch.expected + expected > kSubmitSeconds);
    if (batch.recording && full) submit();
    return slot(next_).recording || start(slot(next_));
}

bool Recorder::start(Batch& batch) {
    if (next_ > kBatches) wait(next_ - kBatches);
    if (failure_) return false;
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkResult result = vkBeginCommandBuffer(batch.target.commands, &info);
    if (result != VK_SUCCESS) {
        fail_with(vk::failure(result, "recording GPU work").value());
        return false;
    }
    batch.target.bound = VK_NULL_HANDLE;
    batch.number = next_;
    batch.recording = true;
    batch.expected = 0;
    if (batch.queries.get()) {
        vkResetQueryPool(gpu_->get(), batch.queries.get(), 0, kBatchEntries + 1);
        vkCmdWriteTimestamp(batch.target.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            batch.queries.get(), 0);
    }
    return true;
}

void Recorder::add_entry(const Entry& entry) {
    Batch& batch = slot(next_);
    batch.entries.push_back(entry);
    batch.expected += entry.expected;
    unordered_ = true;
    if (!batch.queries.get()) return;
    vkCmdWriteTimestamp(batch.target.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                        batch.queries.get(), static_cast<uint32_t>(batch.entries.size()));
}

void Recorder::barrier() {
    if (!unordered_ || !begin(0)) return;
    RecordTarget& target = slot(next_).target;
    target.end_drawing();
    VkMemoryBarrier all{};
    all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    all.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                        VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                        VK_ACCESS_HOST_READ_BIT;
    VkPipelineStageFlags device =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    if (target.end_rendering) {  // any stage of drawing may have written, or read next
        device = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        all.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
        all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    }
    vkCmdPipelineBarrier(target.commands, device, device | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &all,
                         0, nullptr, 0, nullptr);
    unordered_ = false;
}

void Recorder::submit() {
    Batch& batch = slot(next_);
    if (!batch.recording || failure_) return;
    batch.target.end_drawing();
    batch.recording = false;
    VkResult result = vkEndCommandBuffer(batch.target.commands);
    if (result != VK_SUCCESS) return fail_with(vk::failure(result, "recording GPU work").value());
    auto ticket = gpu_->submit(batch.target.commands, describe(batch));
    if (!ticket) return fail_with(std::move(ticket).error());
    batch.ticket = *ticket;
    batch.submitted = Clock::now();
    ++next_;
}

void Recorder::wait(uint64_t number) {
    if (number <= finished_) return;
    Status status = gpu_->wait(slot(number).ticket, describe(slot(number)));
    if (!status) return fail_with(std::move(status).error());
    while (finished_ < number) collect(slot(++finished_));
}

void Recorder::finish() {
    barrier();  // also makes the results visible to the host and to what comes next
    submit();
    wait(next_ - 1);
    timings_.forget_kernels();
}

void Recorder::collect(Batch& batch) {
    std::vector<double> seconds = batch.queries.get() ? entry_seconds(batch) : host_seconds(batch);
    double total = 0;
    for (size_t i = 0; i < seconds.size(); ++i) {
        const Entry& entry = batch.entries[i];
        timings_.add(entry.row, seconds[i], entry.first);
        entry.rate->add(entry.groups, seconds[i]);
        total += seconds[i];
    }
    submit_seconds_.push_back(total);
    batch.entries.clear();
}

/// GPU time of each entry of a batch that has finished. Entries may overlap on the device: each
/// counts from the end of the one before it.
std::vector<double> Recorder::entry_seconds(const Batch& batch) {
    size_t count = batch.entries.size();
    std::vector<uint64_t> times(count + 1);
    VkResult result =
        vkGetQueryPoolResults(gpu_->get(), batch.queries.get(), 0, static_cast<uint32_t>(count + 1),
                              times.size() * sizeof(uint64_t), times.data(), sizeof(uint64_t),
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    std::vector<double> seconds(count, 0.0);
    if (result != VK_SUCCESS) {
        fail_with(vk::failure(result, "reading timestamps").value());
        return seconds;
    }
    for (size_t i = 0; i < count; ++i) {
        uint64_t steps = (times[i + 1] - times[i]) & gpu_->physical().timestamp_mask;
        seconds[i] = static_cast<double>(steps) * gpu_->timestamp_period() * 1e-9;
    }
    return seconds;
}

/// Stands in for GPU time where there are no timestamps: the time since the batch was handed over,
/// or since the one before it was seen to have finished, shared out as the entries' times were
/// expected.
std::vector<double> Recorder::host_seconds(const Batch& batch) {
    Clock::time_point now = Clock::now();
    std::chrono::duration<double> total = now - std::max(batch.submitted, idle_since_);
    idle_since_ = now;
    std::vector<double> seconds;
    for (const Entry& entry : batch.entries)
        seconds.push_back(total.count() * entry.expected / batch.expected);
    return seconds;
}

}  // namespace aglow::vk
