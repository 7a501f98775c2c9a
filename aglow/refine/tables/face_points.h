// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/subdivision.h"

#include <cstdint>
#include <vector>

namespace aglow::refine {

/// A refined point of a face, in segments from corner 0: x along edge 0, y along the last edge.
struct LatticePoint {
    uint32_t x = 0, y = 0;
};

/// Which column of a table each refined point of a face has (see FaceTables), and its faces.
struct FacePoints {
    uint32_t corners = 3, segments = 1;
    std::vector<uint32_t> column;                ///< [y * (segments + 1) + x]
    std::vector<LatticePoint> points;            ///< [column]
    std::vector<std::array<uint32_t, 4>> faces;  ///< columns; triangles use the first three

    uint32_t at(LatticePoint p) const { return column[p.y * (segments + 1) + p.x]; }
    uint32_t count() const { return static_cast<uint32_t>(points.size()); }
    uint32_t interior() const { return count() - corners * segments; }
};

/// Of a triangle or a quad. Faces come in the order of triangle_pattern(), or row by row.
FacePoints face_points(uint32_t corners, uint32_t segments);

}  // namespace aglow::refine
