// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/trace_scene.h"
#include "aglow/mesh/gpu/part_motion.h"
#include "aglow/mesh/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// Surfaces whose triangles lie together where they move alike: all that stands still, then all
/// that deforms, then one body after another.
struct MotionGroups {
    Surfaces surfaces;                ///< vertices and parts in their order
    std::vector<uint32_t> source_of;  ///< [triangle_count] places before
    std::vector<accel::gpu::Group> groups;
    std::vector<uint32_t> part_of;  ///< [groups] a part of each, whose transform it follows

    /// Places of triangles now, from those before.
    std::vector<uint32_t> place_of() const;
};

/// `motions` are those of surfaces.parts. Bodies beyond `most_bodies`, the smallest first, count
/// as deforming.
MotionGroups motion_groups(Surfaces surfaces, std::span<const mesh::gpu::PartMotion> motions,
                           size_t most_bodies);

}  // namespace aglow::render::gpu
