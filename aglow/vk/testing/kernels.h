// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/testing/demand.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/testing/iota.comp.h"
#include "aglow/vk/testing/shift.comp.h"

#include <array>
#include <numeric>
#include <vector>

namespace aglow::vk::testing {

/// Push constants of iota.comp: values[i] = value + i.
struct IotaArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t values = 0;
    uint32_t value = 0;
};

/// Push constants of shift.comp: to[to_start + i] = from[from_start + i] + add.
struct ShiftArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t from = 0, to = 0;
    uint32_t from_start = 0, to_start = 0;
    uint32_t rounds = 0;  ///< of idle work
};

inline Kernel iota_kernel(const Gpu& gpu) {
    return demand(Kernel::create(gpu, "iota", shaders::iota_comp));
}

inline Kernel shift_kernel(const Gpu& gpu, uint32_t add = 0) {
    return demand(Kernel::create(gpu, "shift", shaders::shift_comp, std::array{add}));
}

inline std::vector<uint32_t> numbers(uint32_t first, uint64_t count) {
    std::vector<uint32_t> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

}  // namespace aglow::vk::testing
