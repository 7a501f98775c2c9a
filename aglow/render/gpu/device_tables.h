// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/render/tables/tables.h"
#include "aglow/shared/device_scene.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// What shading reads of a scene, but for what moves.
struct TableSource {
    const Scene& scene;
    const Surfaces& surfaces;             ///< triangles in the device's order
    std::span<const uint32_t> source_of;  ///< [triangle_count] their places before that
    const Image* stored = nullptr;        ///< irradiance of a lightmap, lux; null: none
    const Image* resting = nullptr;       ///< its part that does not follow motion; null: none
    const EmitterTable& emitters;         ///< triangles in the device's order
    const SkyTable& sky;
};

/// That on the device.
class DeviceTables {
public:
    /// Errors  out_of_memory (says the bytes that the scene needs and those that are free, or names
    ///         the table), device_lost.
    /// Synchronisation  Ends without barrier.
    static Result<DeviceTables> create(vk::Stream& stream, const TableSource& source);

    /// The scene but for corners, normals, triangles and lights, which its user fills in.
    /// `resting` chooses between the two lightmaps.
    shared::DeviceScene scene(bool resting) const;
    /// Some material is cut out or blended.
    bool has_alpha() const { return has_alpha_; }
    bool has_textures() const { return scene_.textures != 0; }
    bool has_emitters() const { return scene_.emitter_count > 0; }
    /// A sky that is not black.
    bool has_sky() const {
        return luminance(scene_.sky_luminance) > 0 &&
               (scene_.sky_width == 0 || scene_.sky_sampled != 0);
    }

private:
    DeviceTables() = default;
    std::vector<vk::Buffer> buffers_;
    shared::DeviceScene scene_{};
    shared::vec3Ptr resting_ = 0;  // lightmap, or 0
    bool has_alpha_ = false;
};

}  // namespace aglow::render::gpu
