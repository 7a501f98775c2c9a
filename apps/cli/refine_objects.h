// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"

#include <string>
#include <vector>

namespace aglow::cli {

/// A coarse mesh of triangles to subdivide.
struct CoarseObject {
    Topology topology;
    std::vector<vec3> positions;
};

/// Chess pieces made by code ("pawn", "bishop", "queen", "king"), a cube of 12 triangles ("cube"),
/// or "teapot", "spoon", "cup" from a file of bicubic Bezier patches: an object per piece of
/// {"patches": [[16 indices]], "points": [[x, y, z]]}, of which the body and the handle are
/// completed by symmetry.
/// Errors  bad_argument (no such object), unreadable and malformed (the file)
Result<CoarseObject> coarse_object(const std::string& name, const std::string& teaset);

}  // namespace aglow::cli
