// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/refine/edge_detail.h"
#include "aglow/refine/gpu/device_patches.h"
#include "aglow/render/gpu/raster/control_scene.h"
#include "aglow/render/gpu/raster/corner_normals.h"
#include "aglow/render/raster.h"
#include "aglow/vk/stream.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// Patches over all meshes of a scene: curved ones, and flat ones where a mesh names a height map,
/// which displaces it.
class ScenePatches {
public:
    /// Creases and scalar tags count as `refinement` says, the latter with `tagged` and
    /// `automatic`. `segments` says for how many on each edge height maps are filtered, unless
    /// set_levels() is called. Errors  unsupported, out_of_memory, device_lost; those of
    /// read_height_map()
    static Result<ScenePatches> create(vk::Stream& stream, const Scene& scene, const Surfaces& rest,
                                       const Refinement& refinement, int segments);

    /// Control points of the posed surfaces, which are those that it was made for.
    /// Synchronisation  Starts and ends without barrier.
    void update(vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces);

    /// Segments of every edge, [edge] whole.
    /// Synchronisation  Follows update(), starts and ends without barrier.
    void set_levels(vk::Stream& stream, std::span<const float> levels) const;

    const ControlScene& control() const { return control_; }
    const refine::gpu::DevicePatches& patches() const { return *patches_; }
    bool is_displaced() const { return !control_.displaced.empty(); }
    /// [edge], of lengths in the rest pose; empty: nothing is displaced.
    std::vector<EdgeDetail> details() const;
    /// [face] How far displacement moves it at most, m in the rest pose; empty likewise.
    std::vector<float> reach() const;
    /// See VertexSource.
    float overhang() const { return overhang_; }

private:
    ScenePatches() = default;
    Status read_heights(const Scene& scene);
    void find_kinds(const Scene& scene, const Surfaces& rest, int segments);
    std::vector<DetailSource> sources() const;
    void set_mips(vk::Stream& stream, std::span<const float> levels) const;

    ControlScene control_;
    std::vector<std::shared_ptr<const HeightMap>> maps_;  ///< [displaced] with scale and bias
    std::vector<float> highest_;                          ///< [displaced] m in the mesh
    std::vector<bool> stiff_;                             ///< [displaced] placed by its part
    std::vector<refine::gpu::PatchKind> kinds_;           ///< [1 + displaced]
    std::vector<float> texels_;                           ///< [edge] see edge_texels()
    float overhang_ = 0.5f;  ///< control points are a third of an edge off
    std::optional<CornerNormals> normals_;
    std::optional<refine::gpu::DevicePatches> patches_;
};

}  // namespace aglow::render::gpu
