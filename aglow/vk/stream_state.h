// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/recorder.h"
#include "aglow/vk/staging_ring.h"
#include "aglow/vk/stream.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace aglow::vk {

constexpr uint64_t kUploadRing = uint64_t{8} << 20;
constexpr uint64_t kCopyUnit = uint64_t{64} << 10;  // bytes; the "group" of copies and fills
constexpr double kCopySeconds = static_cast<double>(kCopyUnit) / 1e9;  // 1 GB/s, until measured

/// What a stream is behind its interface.
struct Stream::State {
    explicit State(Gpu device) : gpu(std::move(device)) {}

    Gpu gpu;  // outlives the buffers
    std::unique_ptr<Recorder> recorder;
    std::shared_ptr<KernelRate> copy_rate = std::make_shared<KernelRate>(kCopySeconds);
    std::shared_ptr<KernelRate> fill_rate = std::make_shared<KernelRate>(kCopySeconds);
    std::shared_ptr<KernelRate> clear_rate = std::make_shared<KernelRate>(kCopySeconds);
    std::shared_ptr<KernelRate> read_rate = std::make_shared<KernelRate>(kCopySeconds);
    StagingRing upload_ring{kUploadRing};
    Buffer upload_buffer;
    Buffer readback_buffer;

    Status reserve(Buffer& buffer, uint64_t bytes, std::string_view name, Memory memory);
    std::optional<uint64_t> stage(std::span<const std::byte> data);
    template <class Done>
    void copy(VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset, uint64_t bytes,
              Done done);
    ~State() { recorder.reset(); }  // waits for the work that uses the buffers
};

}  // namespace aglow::vk
