// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/patches.h"

namespace aglow::refine::cpu {

/// Patches::evaluate() vertex by vertex, for levels and displacements of any kind.
/// `displacement` may be null; `positions` or `normals` may be empty: then they are left out.
/// `flat` says that the patches are, so that normals over a height map follow from where it puts
/// the surface; those of curved patches, which are smoother than these, are tilted.
void evaluate_general(const Topology& topology, const PatchControl& control,
                      const Tessellation& tessellation, const DisplacementMap* displacement,
                      bool flat, std::span<vec3> positions, std::span<vec3> normals);

}  // namespace aglow::refine::cpu
