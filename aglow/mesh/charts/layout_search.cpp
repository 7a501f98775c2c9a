// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/layout.h"

#include <algorithm>
#include <cmath>

namespace aglow::mesh {
namespace {

struct Extents {
    double area = 0;     ///< of all boxes in all placements, m^2
    double longest = 0;  ///< side of a box, m
    size_t box_count = 0;
};

Extents extents_of(const std::vector<LayoutGroup>& groups) {
    Extents extents;
    for (const LayoutGroup& group : groups)
        for (double scale : group.scales)
            for (const Point2& box : group.boxes) {
                extents.area += box.x * box.y * scale * scale;
                extents.longest = std::max({extents.longest, box.x * scale, box.y * scale});
                ++extents.box_count;
            }
    return extents;
}

/// Halves the interval (fails, works) of texel sizes on a logarithmic scale, `steps` times, and
/// keeps the best layout that works.
template <class TryIt>
void bisect(double fails, double works, int steps, Layout& best, TryIt try_it) {
    for (int i = 0; i < steps; ++i) {
        const double middle = std::sqrt(fails * works);
        if (std::optional<Layout> layout = try_it(middle)) {
            best = std::move(*layout);
            works = middle;
        } else {
            fails = middle;
        }
    }
}

}  // namespace

std::optional<Layout> finest_layout(const std::vector<LayoutGroup>& groups,
                                    const LayoutBounds& bounds) {
    const Extents extents = extents_of(groups);
    const double ideal = std::sqrt(extents.area / bounds.width / bounds.max_height);
    if (!(ideal > 0)) return lay_out(groups, {1, 1}, bounds, PackEffort::quick);
    const auto square = [&](PackEffort effort) {
        return [&, effort](double t) { return lay_out(groups, {t, t}, bounds, effort); };
    };
    // From the size that would fill the atlas without a gap upwards, until all fits.
    double fails = ideal, works = ideal * 1.1;
    std::optional<Layout> best = square(PackEffort::quick)(works);
    while (!best) {
        // Beyond this every chart already is a single texel.
        if (works > 2 * extents.longest) return std::nullopt;
        fails = works;
        works *= 1.25;
        best = square(PackEffort::quick)(works);
    }
    bisect(fails, works, 6, *best, square(PackEffort::quick));
    // Sizes are whole texels, so a slightly finer texel may fit where a coarser one did not.
    const bool few = extents.box_count <= 2000;
    if (few) {
        const double t = best->texel.x;
        bisect(t * 0.9, t, 8, *best, square(PackEffort::thorough));
        for (int i = 1; i <= 8; ++i)
            if (auto finer =
                    lay_out(groups, best->texel * (1 - 0.004 * i), bounds, PackEffort::thorough))
                best = std::move(finer);
    }
    // Rows that are left over serve to make texels finer along v.
    const double t = best->texel.x;
    const double finest = std::max(1 / kMostOblong, 0.95 * best->height / bounds.max_height);
    if (best->height < bounds.max_height)
        bisect(t * finest, t, few ? 10 : 5, *best, [&](double v) {
            return lay_out(groups, {t, v}, bounds, few ? PackEffort::thorough : PackEffort::quick);
        });
    return best;
}

std::optional<Layout> smallest_layout(const std::vector<LayoutGroup>& groups, double texel,
                                      int max_resolution, int gutter) {
    const Extents extents = extents_of(groups);
    const double side = std::sqrt(extents.area) / texel +
                        gutter * std::sqrt(double(extents.box_count)) + 2.0 * gutter + 1;
    std::optional<Layout> best;
    double least = 0;
    for (const double factor : {0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 2.0, 3.0, 1e9}) {
        const double wanted = std::ceil(side * factor);
        const int width = static_cast<int>(std::min(wanted, double(max_resolution)));
        if (factor > 1.5 && best) break;
        auto layout =
            lay_out(groups, {texel, texel}, {width, max_resolution, gutter}, PackEffort::quick);
        if (!layout) continue;
        const double longer = std::max(layout->width, layout->height);
        // Area, and a little for being far from square.
        const double cost = double(layout->width) * layout->height + 0.1 * longer * longer;
        if (!best || cost < least) {
            best = std::move(layout);
            least = cost;
        }
    }
    return best;
}

}  // namespace aglow::mesh
