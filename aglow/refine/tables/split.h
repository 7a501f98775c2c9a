// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/refine/subdivision.h"

namespace aglow::refine {

/// The mesh after one step of subdivision: every triangle in four (Loop), every polygon in as many
/// quads as it has corners (Catmull-Clark). Numbers follow from those of the mesh before:
///   vertices    those before; one per edge; Catmull-Clark: one per face
///   edges       2e and 2e + 1, the halves of e from the start of edge_half[e]; then inner ones
///   faces       Loop: 4f + i at corner i, 4f + 3 in the middle; Catmull-Clark: one per corner h,
///               which is its corner 0 where Loop's is corner i
///   sharpness   uniform: 1 less, until 0; from kSharp on it stays
/// Sources of vertices and faces are left out.
Topology split(const Topology& mesh, Scheme scheme);

/// Sharpness one level on.
inline float child_sharpness(float s) { return s >= kSharp ? s : s > 1 ? s - 1 : 0.0f; }

}  // namespace aglow::refine
