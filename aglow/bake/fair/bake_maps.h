// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/bake/fair/coarse_surface.h"
#include "aglow/core/progress.h"

#include <cstdint>
#include <vector>

namespace aglow::bake::fair {

struct Maps {
    std::vector<float> heights;    ///< [height * width] m
    std::vector<uint8_t> normals;  ///< [height * width * 3] glTF's tangent-space normals
    double missed = 0;             ///< share of the charts' texels
};

/// Traces a line through every texel of the charts and their gutters, along the coarse surface's
/// normal, to the dense mesh, which is taken as it stands.
/// Units   reach m: how far the dense surface may be
/// Errors  out_of_memory, cancelled
Result<Maps> bake_maps(const CoarseSurface& coarse, const Mesh& dense, int width, int height,
                       float reach, const Monitor& monitor);

}  // namespace aglow::bake::fair
