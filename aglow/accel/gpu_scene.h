// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace aglow {

/// Which structure finds what a ray hits. automatic: choose_accel().
enum class Accel : uint8_t { automatic, grid, grid2, bvh };

const char* name(Accel accel);  ///< as the command line spells it

/// What choosing a structure depends on.
struct AccelDemand {
    uint64_t triangles = 0;
    double rays_per_build = std::numeric_limits<double>::infinity();  ///< until they move again
};

/// The structure whose build and rays together take least time, by the measured rule in
/// docs/performance.md: build seconds + rays * seconds per ray, both as functions of the number of
/// triangles.
Accel choose_accel(const AccelDemand& demand);

/// Whether rays count the work that they cause, which makes them slower.
enum class Counting : uint8_t { off, on };

/// Cost of a structure that does not depend on the machine.
struct AccelStats {
    uint64_t bytes = 0;           ///< of the structure, its copy of the triangles included
    uint64_t references = 0;      ///< triangles in cells or leaves, repeated ones counted
    uint64_t cells = 0;           ///< cells or nodes
    uint64_t rays = 0;            ///< traced with counting since the last build
    uint64_t steps = 0;           ///< cells or nodes that they visited
    uint64_t triangle_tests = 0;  ///< that they caused
};

/// Time on the device, s.
struct AccelSeconds {
    double build = 0;  ///< of the last build, its triangles being there
    double trace = 0;  ///< of the last batch of rays, without their way there and back
};

/// What a ray hits, on the GPU: opaque triangles of posed surfaces. For many rays at once.
/// Thread safety  one thread at a time.
class GpuScene {
public:
    /// Copies what it needs of `surfaces`. `demand` chooses the structure where accel is automatic;
    /// its number of triangles is taken from the surfaces.
    /// Errors  out_of_memory (says the bytes needed), device_lost, unsupported.
    static Result<GpuScene> create(const Gpu& gpu, const Surfaces& surfaces, Accel accel,
                                   const AccelDemand& demand = {});
    GpuScene(GpuScene&&) noexcept;
    GpuScene& operator=(GpuScene&&) noexcept;
    ~GpuScene();

    Accel accel() const;  ///< the structure in use
    /// Rebuilds over surfaces with as many triangles whose positions changed. After an error
    /// rays give that error until a rebuild succeeds.
    /// Errors  as create().
    Status rebuild(const Surfaces& surfaces);

    /// Where a ray meets a triangle of the surfaces.
    struct GpuHit {
        float distance;  ///< ray.far where nothing is hit
        uint32_t triangle;
        vec2 barycentrics;  ///< as SurfacePoint's
    };
    static constexpr uint32_t kNoHit = 0xffffffffu;

    /// Nearest hits within (0, far), in the order of the rays; triangle = kNoHit where there is
    /// none.
    /// Errors  out_of_memory, device_lost.
    /// Cost    rays are traced in batches of 2^18, of 48 bytes each.
    /// Repeat  same hits every run on one device.
    Result<std::vector<GpuHit>> intersect(std::span<const Ray> rays,
                                          Counting counting = Counting::off);
    /// 1 where something stands within (0, far). Errors and cost as intersect().
    Result<std::vector<uint32_t>> occluded(std::span<const Ray> rays,
                                           Counting counting = Counting::off);

    AccelStats stats() const;
    AccelSeconds seconds() const;

private:
    struct State;
    explicit GpuScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow
