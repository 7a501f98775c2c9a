// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/tables/layout.h"
#include "aglow/refine/tables/state.h"

#include <vector>

namespace aglow::refine {

/// The vertices of split(mesh) as sums of those of the mesh.
Stencils split_stencils(const Topology& mesh, Scheme scheme);

/// Rings, classes and tables of all faces, which have three corners for Loop, four for
/// Catmull-Clark; all but the output. `class_face` gets a face of every class.
/// Cost  faces + classes * ring * points of a face; a mesh has few classes: one for every
///       combination of valences, boundaries and sharp edges at a face's corners.
FaceTables face_tables(const Topology& mesh, Scheme scheme, int level,
                       std::vector<uint32_t>& class_face);

/// The tables for the limit, of the same faces.
LimitWeights limit_weights(const Topology& mesh, Scheme scheme, const FaceTables& faces,
                           const std::vector<uint32_t>& class_face);

}  // namespace aglow::refine
