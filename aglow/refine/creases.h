// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"
#include "aglow/refine/subdivision.h"

#include <span>
#include <vector>

namespace aglow {

/// The mesh with sharp vertices where its boundary turns by more than 75 degrees, if corners are to
/// be sharp.
/// Shapes  positions [vertex]
Topology with_corners(Topology mesh, std::span<const vec3> positions, Corners corners);

/// A mesh cut open along the edges that stay sharp for ever (Topology::edge_sharpness >= kSharp),
/// which has the normals on both of their sides. Subdivided, its boundaries follow the same curves
/// as the creases, but for rounding: only normals are taken from it.
struct CreaseSides {
    Topology mesh;             ///< the same faces and half-edges; empty: no edge is sharp
    std::vector<bool> parted;  ///< [vertex before] It has several normals. A crease that ends
                               ///< inside the surface fades there: its end has one.

    bool empty() const { return mesh.face_count() == 0; }
};

/// Errors  out_of_memory.   Cost  O(n)
Result<CreaseSides> crease_sides(const Topology& topology);

}  // namespace aglow
