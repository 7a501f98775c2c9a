// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/pass_times.h"

#include <algorithm>
#include <string>

namespace aglow::render::gpu {

std::vector<PassTime> pass_times(const std::vector<vk::Timing>& timings, double wall) {
    std::vector<PassTime> passes;
    for (const vk::Timing& timing : timings) {
        const std::string pass = timing.label.empty() ? "other" : timing.label;
        auto known = std::find_if(passes.begin(), passes.end(),
                                  [&](const PassTime& p) { return p.pass == pass; });
        if (known == passes.end()) known = passes.insert(passes.end(), {pass, 0});
        known->seconds += timing.seconds;
        wall -= timing.seconds;
    }
    passes.push_back({"host", std::max(wall, 0.0)});
    return passes;
}

}  // namespace aglow::render::gpu
