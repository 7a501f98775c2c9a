// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/gpu/part_motion.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/vk/stream.h"

#include <memory>
#include <span>
#include <vector>

namespace aglow::mesh::gpu {

/// The surfaces of a scene on the device, posed there: what pose() does on the host, twin by twin.
/// World transforms of nodes come from the host (world_transforms(): few and sequential); vertices
/// are morphed, skinned and placed on the device. Positions and normals differ from pose()'s by the
/// rounding of fused products.
/// Lifetime       keeps what it needs of the scene; must not die between pose() and the submit.
/// Thread safety  one thread at a time.
class DeviceSurfaces {
public:
    /// `rest` is pose(scene, any time, atlas): its topology and its vertices' order are kept. Waits
    /// until all is on the device.
    /// Errors  out_of_memory (names the buffer), device_lost, unsupported.
    static Result<DeviceSurfaces> create(vk::Stream& stream, const Scene& scene,
                                         const Surfaces& rest);
    DeviceSurfaces(DeviceSurfaces&&) noexcept;
    DeviceSurfaces& operator=(DeviceSurfaces&&) noexcept;
    ~DeviceSurfaces();

    /// Poses what moves at `time` (negative: rest) and gathers its triangles. The first call poses
    /// all, and so does one that goes from the rest pose to a time >= 0 or back.
    /// Synchronisation  Writes all that the addresses below point to. Starts and ends without
    ///                  barrier.
    /// Cost    O(vertices and triangles that move); morph targets of weight 0 cost nothing.
    Status pose(vk::Stream& stream, double time);

    /// Addresses. Counts as in Surfaces; positions, normals and corners are world space at the
    /// time of the last pose(), and so is which way round the indices run.
    uint64_t positions() const;  ///< vec3[vertex_count]
    uint64_t normals() const;    ///< vec3[vertex_count] unit
    uint64_t indices() const;    ///< uvec3[triangle_count]
    uint64_t corners() const;    ///< shared::Triangle[triangle_count]
    uint32_t vertex_count() const;
    uint32_t triangle_count() const;

    std::span<const PartMotion> part_motions() const;  ///< [parts]
    /// [parts] World transforms (node and instance) at the time of the last pose(). A skinned part
    /// is not placed by its own.
    std::span<const mat4> part_transforms() const;

private:
    struct State;
    explicit DeviceSurfaces(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow::mesh::gpu
