// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/render/gpu/device_tables.h"
#include "aglow/vk/stream.h"

#include <cstdint>

namespace aglow::render::gpu {

/// A scene on the device, at one time after another: its surfaces, what shades them, and the
/// punctual lights that light them.
/// Lifetime  the scene must outlive it.
class DeviceFootage {
public:
    /// Waits until all is on the device.
    /// Errors  out_of_memory (says what for), device_lost, unsupported.
    static Result<DeviceFootage> create(vk::Stream& stream, const TableSource& source);

    /// Brings the surfaces to `time` (negative: the rest pose).
    /// Synchronisation  Ends with a barrier.
    Status pose(vk::Stream& stream, double time);
    /// Brings lights to `time`, and tells shaders where all is. `resting`: see
    /// DeviceTables::scene().
    /// Synchronisation  Starts and ends without barrier.
    void place(vk::Stream& stream, double time, bool resting) const;

    uint64_t scene() const { return device_scene_.address(); }  ///< address of shared::DeviceScene
    const mesh::gpu::DeviceSurfaces& surfaces() const { return surfaces_; }
    const DeviceTables& tables() const { return tables_; }
    uint32_t light_count() const { return light_count_; }

private:
    DeviceFootage(const Scene& scene, DeviceTables tables, mesh::gpu::DeviceSurfaces surfaces);

    const Scene* scene_;
    DeviceTables tables_;
    mesh::gpu::DeviceSurfaces surfaces_;
    uint32_t light_count_ = 0;
    vk::Buffer lights_, photometry_, device_scene_;
};

}  // namespace aglow::render::gpu
