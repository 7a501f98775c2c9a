// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/patches.h"

namespace aglow::refine::cpu {

/// Patches::evaluate() where all edges have the same number of segments: the polynomials of a row
/// of the pattern are made once, by powers of its coordinate, and the results written past the
/// caches.
void evaluate_uniform(const Topology& topology, const PatchControl& control,
                      const Tessellation& tessellation, std::span<vec3> positions);

}  // namespace aglow::refine::cpu
