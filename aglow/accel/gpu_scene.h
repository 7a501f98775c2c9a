// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace aglow {

/// Which structure finds what a ray hits. automatic: choose_accel().
enum class Accel : uint8_t { automatic, grid, grid2, bvh };

const char* name(Accel accel);  ///< as the command line spells it

/// What choosing a structure depends on.
struct AccelDemand {
    uint64_t triangles = 0;
    double rays_per_build = 0;  ///< rays until the triangles move again
};

/// The structure whose build and rays together take least time, by the measured rule in
/// docs/performance.md.
Accel choose_accel(const AccelDemand& demand);

/// Cost of a structure that does not depend on the machine.
struct AccelStats {
    uint64_t bytes = 0;
    uint64_t references = 0;
    uint64_t cells = 0;
    uint64_t rays = 0;   ///< traced with counting since the last build
    uint64_t steps = 0;  ///< cells or nodes they visited
    uint64_t triangle_tests = 0;
};

/// What a ray hits, on the GPU: opaque triangles of posed surfaces. For many rays at once.
/// Thread safety  one thread at a time.
class GpuScene {
public:
    /// Copies what it needs of `surfaces`.
    /// Errors  out_of_memory (says the bytes needed), device_lost, unsupported.
    static Result<GpuScene> create(const Gpu& gpu, const Surfaces& surfaces, Accel accel,
                                   const AccelDemand& demand = {});
    GpuScene(GpuScene&&) noexcept;
    GpuScene& operator=(GpuScene&&) noexcept;
    ~GpuScene();

    Accel accel() const;  ///< the structure in use
    /// Rebuilds over surfaces with as many triangles whose positions changed.
    Status rebuild(const Surfaces& surfaces);

    /// Nearest hits within (0, far), in the order of the rays; triangle = kNoHit where there is
    /// none.
    struct GpuHit {
        float distance;
        uint32_t triangle;
        vec2 barycentrics;
    };
    static constexpr uint32_t kNoHit = 0xffffffffu;
    Result<std::vector<GpuHit>> intersect(std::span<const Ray> rays);
    /// 1 where something stands within (0, far).
    Result<std::vector<uint32_t>> occluded(std::span<const Ray> rays);

    AccelStats stats() const;

private:
    struct State;
    explicit GpuScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow
