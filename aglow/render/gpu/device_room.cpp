// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/device_room.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::render::gpu {

Status check_room(const vk::Device& device, uint64_t needed, std::string_view what,
                  std::string_view advice) {
    const uint64_t all = device.info().memory_bytes;
    const uint64_t free = all - std::min(all, device.bytes_in_use());
    if (needed <= free) return {};
    constexpr double kMebibyte = 1024.0 * 1024.0;
    return fail(Errc::out_of_memory,
                fmt::format("{} at least {:.0f} MiB on {}, where {:.0f} MiB are free; {}", what,
                            static_cast<double>(needed) / kMebibyte, device.info().name,
                            static_cast<double>(free) / kMebibyte, advice));
}

}  // namespace aglow::render::gpu
