// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/trace_rays.h"

#include "aglow/accel/gpu/trace_rays.comp.h"

namespace aglow::accel::gpu {

Status TraceRays::prepare(uint32_t kinds, Query query, Counting counting) {
    const Constants values = constants(kinds, query, counting);
    if (kernels_.contains(values)) return {};
    AG_TRY(vk::Kernel kernel,
           vk::Kernel::create(gpu_, "trace rays", shaders::trace_rays_comp, values));
    kernels_.emplace(values, std::move(kernel));
    return {};
}

void TraceRays::record(vk::Stream& stream, uint32_t kinds, Query query, Counting counting,
                       const shared::TraceRaysArgs& args) const {
    stream.run(kernels_.at(constants(kinds, query, counting)), args,
               vk::group_count(args.ray_count, shared::kTraceGroupSize));
}

}  // namespace aglow::accel::gpu
