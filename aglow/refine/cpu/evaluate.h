// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/tables/state.h"

#include <cstdint>
#include <span>

namespace aglow::refine::cpu {

/// Up to three numbers of every point of an array whose points have `width`.
struct Channels {
    const float* values = nullptr;  ///< of the first point
    size_t width = 3;
    uint32_t count = 3;
};

/// The same numbers of points that are written.
struct OutputChannels {
    float* values = nullptr;
    size_t width = 3;
    uint32_t count = 3;
};

/// to[i] = sum of points by row i.
void sum_stencils(const Stencils& stencils, Channels from, OutputChannels to);

/// Writes what every face owns. Every sum is of products rounded one by one, row after row, so that
/// no processor gives other bits.
/// Cost  rows * points multiplications and additions in registers, one pass over the output.
void sum_faces(const FaceTables& faces, Channels points, OutputChannels to);

/// Likewise where they go in the limit, and unit normals there (0 where they are not defined).
void sum_limits(const FaceTables& faces, const LimitWeights& limit, Channels points,
                std::span<vec3> positions, std::span<vec3> normals);

}  // namespace aglow::refine::cpu
