// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"
#include "report.h"

#include <optional>
#include <string>

namespace aglow::cli {

/// What --device asks for: nothing for the CPU. `auto` is the best GPU of hardware, and the CPU
/// where there is none; `gpu` the best of any kind; gpu:NAME the best whose name contains NAME.
/// Errors  unsupported  a GPU that was asked for is not there, or lacks what Aglow needs
///         device_lost  its driver failed
Result<std::optional<Gpu>> choose_device(const std::string& device);

/// The CPU with `threads` threads (0: one for each core), then all GPUs, best first.
Json device_list(int threads);

}  // namespace aglow::cli
