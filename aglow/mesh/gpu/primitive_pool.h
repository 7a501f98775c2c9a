// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/scene.h"
#include "aglow/shared/pose.h"
#include "aglow/vk/buffer.h"
#include "aglow/vk/stream.h"

#include <map>
#include <span>
#include <utility>
#include <vector>

namespace aglow::mesh::gpu {

/// The primitives at rest, on the device: each once, however often it is placed.
class PrimitivePool {
public:
    /// Room for the primitives of `parts`. Errors: out_of_memory.
    static Result<PrimitivePool> create(const Gpu& gpu, const Scene& scene,
                                        std::span<const SurfacePart> parts);
    /// Fills it. `scene` is that of create().
    void upload(vk::Stream& stream, const Scene& scene) const;

    struct Entry {
        uint64_t positions = 0, normals = 0, triangles = 0;
        uint64_t joints = 0, weights = 0;
        uint32_t influences = 0;
        std::vector<shared::PoseTarget> targets;  ///< without weights
    };
    const Entry& entry(const SurfacePart& part) const {
        return entries_.at({part.mesh, part.primitive});
    }

private:
    void place_entries(const Scene& scene);

    std::map<std::pair<int, int>, Entry> entries_;
    vk::Buffer positions_, normals_, triangles_, joints_, weights_, displacements_;
};

}  // namespace aglow::mesh::gpu
