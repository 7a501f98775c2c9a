// SPDX-License-Identifier: Apache-2.0
#include "devices.h"

#include "machine.h"

#include <algorithm>
#include <array>

namespace aglow::cli {
namespace {

std::string kind_name(GpuKind kind) {
    constexpr std::array<const char*, 4> kNames = {"discrete", "integrated", "virtual", "software"};
    return kNames[static_cast<size_t>(kind)];
}

Json describe(const GpuInfo& gpu) {
    Json line = {{"name", "gpu:" + gpu.name},
                 {"kind", kind_name(gpu.kind)},
                 {"driver", gpu.driver},
                 {"vulkan", gpu.api},
                 {"memory_bytes", gpu.memory_bytes},
                 {"subgroup_size", gpu.subgroup_size},
                 {"features", gpu.features}};
    if (!gpu.missing.empty()) line["missing"] = gpu.missing;
    return line;
}

bool is_hardware(const GpuInfo& gpu) {
    return gpu.missing.empty() && gpu.kind != GpuKind::software;
}

}  // namespace

Result<std::optional<Gpu>> choose_device(const std::string& device) {
    if (device == "cpu") return std::nullopt;
    std::string name;
    if (device == "auto") {
        const std::vector<GpuInfo> gpus = list_gpus();
        const auto best = std::find_if(gpus.begin(), gpus.end(), is_hardware);
        if (best == gpus.end()) return std::nullopt;
        name = best->name;
    } else if (device.starts_with("gpu:")) {
        name = device.substr(4);
    }
    AG_TRY(Gpu gpu, open_gpu(name));
    return gpu;
}

Json device_list(int threads) {
    Json devices = {{{"name", "cpu"},
                     {"processor", processor_name()},
                     {"cores", core_count()},
                     {"threads", threads > 0 ? threads : core_count()},
                     {"memory_bytes", memory_bytes()},
                     {"ray_tracing", "Embree 3"}}};
    for (const GpuInfo& gpu : list_gpus()) devices.push_back(describe(gpu));
    return devices;
}

}  // namespace aglow::cli
