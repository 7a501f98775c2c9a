// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/patches.h"

namespace aglow::refine::cpu {

/// Patches::evaluate() vertex by vertex, for levels and displacements of any kind.
/// `displacement` may be null; `positions` or `normals` may be empty: then they are left out.
void evaluate_general(const Topology& topology, const PatchControl& control,
                      const Tessellation& tessellation, const DisplacementMap* displacement,
                      std::span<vec3> positions, std::span<vec3> normals);

}  // namespace aglow::refine::cpu
