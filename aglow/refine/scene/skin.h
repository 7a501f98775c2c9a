// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/scene/refined_surface.h"

namespace aglow::refine {

/// Joints and weights of refined vertices, the largest first.
struct RefinedSkin {
    int influences = 0;            ///< of each vertex: 4, 8, or 0 for a mesh without skin
    std::vector<uint32_t> joints;  ///< [refined vertex of ControlMesh::topology * influences]
    std::vector<float> weights;    ///< likewise; the sum of a vertex's is 1, or 0
};

/// Each joint's weights are interpolated over the surface.
/// Errors  out_of_memory
/// Cost    O(refined vertices * joints)
Result<RefinedSkin> refine_skin(const Mesh& mesh, const ControlMesh& control,
                                const RefinedSurface& surface);

}  // namespace aglow::refine
