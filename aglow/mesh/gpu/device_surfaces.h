// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/vk/stream.h"

#include <memory>
#include <span>
#include <vector>

namespace aglow::mesh::gpu {

/// How a part of the surfaces moves over time.
enum class PartMotion : uint8_t {
    still,     ///< nothing animates it
    rigid,     ///< by its nodes' transforms alone
    deforming  ///< by a skin or morph targets
};

/// The surfaces of a scene on the device, posed there: what pose() does on the host, twin by twin.
/// World transforms of nodes come from the host (world_transforms(): few and sequential); vertices
/// are morphed, skinned and placed on the device.
class DeviceSurfaces {
public:
    /// `rest` is pose(scene, any time, atlas): its topology and its vertices' order are kept.
    /// Errors  out_of_memory, device_lost, unsupported.
    static Result<DeviceSurfaces> create(vk::Stream& stream, const Scene& scene,
                                         const Surfaces& rest);
    DeviceSurfaces(DeviceSurfaces&&) noexcept;
    DeviceSurfaces& operator=(DeviceSurfaces&&) noexcept;
    ~DeviceSurfaces();

    /// Poses what moves at `time` (negative: rest) and gathers its triangles. The first call poses
    /// all. Starts and ends without barrier.
    Status pose(vk::Stream& stream, double time);

    /// Addresses. Counts as in Surfaces; positions, normals and triangles_of_corners are world
    /// space at the time of the last pose().
    uint64_t positions() const;  ///< vec3[vertex_count]
    uint64_t normals() const;    ///< vec3[vertex_count] unit
    uint64_t indices() const;    ///< uvec3[triangle_count]
    uint64_t corners() const;    ///< shared::Triangle[triangle_count]
    uint32_t vertex_count() const;
    uint32_t triangle_count() const;

    std::span<const PartMotion> part_motions() const;  ///< [parts]
    /// World transforms of the parts (node and instance) at the time of the last pose().
    std::span<const mat4> part_transforms() const;

private:
    struct State;
    explicit DeviceSurfaces(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow::mesh::gpu
