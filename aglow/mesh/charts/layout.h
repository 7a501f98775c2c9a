// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/charts/rect_pack.h"
#include "aglow/mesh/raster/polygon.h"

#include <optional>
#include <vector>

namespace aglow::mesh {

/// Charts stay this far (texels) inside the texels they are given, so that the rounding of float
/// UVs cannot push a border into the next texel, up to an atlas of 16384.
inline constexpr double kInset = 1.0 / 128;

/// The charts of one mesh and its placements, as the layout sees them: boxes.
struct LayoutGroup {
    std::vector<Point2> boxes;   ///< [charts] width and height, m
    std::vector<double> scales;  ///< [placements] world size of the boxes
    bool may_turn = true;
};

/// Where a chart's box lies: its lower corner and its size, texels.
struct PlacedBox {
    Point2 corner;
    Point2 size;
    bool turned = false;  ///< by 90 degrees counter-clockwise; `size` is that after turning
};

struct GroupLayout {
    /// One placement: its charts lie anywhere in the atlas, in texels of the atlas. Several: they
    /// share a block, and the boxes are in texels of the block at its smallest placement.
    std::vector<PlacedBox> charts;
    bool is_block = false;
    Point2 block;                       ///< size of the block
    std::vector<PlacedBox> placements;  ///< [placements] where each shows the block
};

struct Layout {
    int width = 0, height = 0;  ///< texels
    Point2 texel;               ///< size of a texel on the surface, m
    std::vector<GroupLayout> groups;
};

struct LayoutBounds {
    int width = 0, max_height = 0;
    int gutter = 0;
};

/// Lays everything out with texels of the given size, or nothing where that does not fit.
std::optional<Layout> lay_out(const std::vector<LayoutGroup>& groups, Point2 texel,
                              const LayoutBounds& bounds, PackEffort effort);

/// The finest texels for an atlas of bounds.width columns and at most bounds.max_height rows.
/// Texels are square unless rows are left over: then they are made finer along v, up to kMostOblong
/// times.
std::optional<Layout> finest_layout(const std::vector<LayoutGroup>& groups,
                                    const LayoutBounds& bounds);

/// The smallest atlas, near to square, for texels of the given size.
std::optional<Layout> smallest_layout(const std::vector<LayoutGroup>& groups, double texel,
                                      int max_resolution, int gutter);

inline constexpr double kMostOblong = 1.4;

}  // namespace aglow::mesh
