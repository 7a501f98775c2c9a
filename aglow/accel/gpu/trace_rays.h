// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/result.h"
#include "aglow/shared/structure.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <array>
#include <map>

namespace aglow::accel::gpu {

enum class Query : uint8_t {
    nearest,  ///< writes TraceRaysArgs::hits
    any       ///< writes TraceRaysArgs::blocked
};

/// Traces rays that lie in a buffer. A kernel is made for each set of kinds that scenes are made
/// of, so that none carries the code of structures that do not occur.
/// Synchronisation  Reads the scene and the rays, writes hits or blocked, and adds to counts.
/// Starts
///                  and ends without barrier.
class TraceRays {
public:
    explicit TraceRays(Gpu gpu) : gpu_(std::move(gpu)) {}

    /// Makes the kernel unless it exists. Call before record().
    /// Errors  unsupported, out_of_memory.
    Status prepare(uint32_t kinds, Query query, Counting counting);
    void record(vk::Stream& stream, uint32_t kinds, Query query, Counting counting,
                const shared::TraceRaysArgs& args) const;

private:
    using Constants = std::array<uint32_t, 3>;  // by constant_id
    static Constants constants(uint32_t kinds, Query query, Counting counting) {
        return {kinds, query == Query::any ? 1u : 0u, counting == Counting::on ? 1u : 0u};
    }

    Gpu gpu_;
    std::map<Constants, vk::Kernel> kernels_;
};

}  // namespace aglow::accel::gpu
