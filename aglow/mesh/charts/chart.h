// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/soup.h"
#include "aglow/mesh/raster/polygon.h"

#include <span>
#include <vector>

namespace aglow::mesh {

/// A piece of surface laid flat: triangles, and where their points lie in the plane.
struct Chart {
    std::vector<uint32_t> triangles;               ///< of the soup
    std::vector<std::array<uint32_t, 3>> corners;  ///< [triangle] indices into uvs
    std::vector<uint32_t> points;                  ///< [uv_count] soup point of each uv
    std::vector<Point2> uvs;                       ///< [uv_count] m, area true on the whole
    double width = 0, height = 0;                  ///< m, of the box from (0, 0) that holds uvs

    Triangle2 triangle(size_t i) const {
        return {uvs[corners[i][0]], uvs[corners[i][1]], uvs[corners[i][2]]};
    }
};

/// A chart over `triangles` whose uvs are not yet known (all zero).
Chart make_chart(const Soup& soup, std::vector<uint32_t> triangles);

/// Area-weighted mean normal, unit, or zero; and the largest angle (radians) of a normal to it.
struct NormalCone {
    Point3 axis;
    double angle = 0;
};
NormalCone normal_cone(const Soup& soup, std::span<const uint32_t> triangles);

/// Orthogonal projection along `axis`, scaled to the true area.
void project(const Soup& soup, Point3 axis, Chart& chart);

/// Conformal map of least squares error, scaled to the true area. The caller judges the result.
/// Cost    a sparse Cholesky factorisation, about O(n^1.5).
/// Result  false where the system is singular; the uvs are then not defined.
/// Source  Levy et al., "Least Squares Conformal Maps", SIGGRAPH 2002.
bool flatten_conformally(const Soup& soup, Chart& chart);

/// Turns the chart so that its bounding box has the least area, longer side upright, and moves it
/// to (0, 0).
/// Source  Freeman & Shapira, "Determining the Minimum-Area Encasing Rectangle", CACM 1975.
void fit_box(Chart& chart);

}  // namespace aglow::mesh
