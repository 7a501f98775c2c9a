// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

/// Judges the layout of an unwrapped scene by brute force, from the posed surfaces alone.
namespace aglow::mesh::testing {

/// Which chart each triangle is in: triangles of one part that share a lightmap UV.
inline std::vector<uint32_t> charts_of(const Surfaces& s) {
    std::vector<uint32_t> parent(s.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::map<std::tuple<int, float, float>, uint32_t> first_at;
    for (const SurfacePart& part : s.parts)
        for (uint32_t v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
            const vec2 uv = s.lightmap_uvs[v];
            const auto [at, added] = first_at.emplace(std::tuple(part.placement, uv.x, uv.y), v);
            if (!added) parent[root(v)] = root(at->second);
        }
    for (const uvec3& t : s.triangles) {
        parent[root(t.y)] = root(t.x);
        parent[root(t.z)] = root(t.x);
    }
    std::vector<uint32_t> charts;
    for (const uvec3& t : s.triangles) charts.push_back(root(t.x));
    return charts;
}

struct LayoutFaults {
    int out_of_range = 0;  ///< lightmap UVs outside the atlas, less its border gutter
    int lost = 0;          ///< triangles of some area without area in the atlas
    int overlaps = 0;      ///< points of a grid of quarter texels inside two triangles
    int near = 0;          ///< covered texels with another chart's within the gutter
    bool none() const { return out_of_range + lost + overlaps + near == 0; }
};

/// Signed distance of p inside the line from a to b.
inline double inside_of(vec2 a, vec2 b, double x, double y) {
    const double ex = double(b.x) - double(a.x), ey = double(b.y) - double(a.y);
    const double norm = std::sqrt(ex * ex + ey * ey);
    return norm > 0 ? (ex * (y - double(a.y)) - ey * (x - double(a.x))) / norm : -1;
}

/// Corners in texels, counter-clockwise.
inline std::array<vec2, 3> texel_corners(const Surfaces& s, uint32_t t) {
    const uvec3 v = s.triangles[t];
    std::array<vec2, 3> p = {s.lightmap_uvs[v.x], s.lightmap_uvs[v.y], s.lightmap_uvs[v.z]};
    const vec2 b = p[1] - p[0], c = p[2] - p[0];
    if (double(b.x) * double(c.y) < double(b.y) * double(c.x)) std::swap(p[1], p[2]);
    return p;
}

inline void check_triangle(const Surfaces& s, uint32_t t, const Atlas& atlas, int gutter,
                           LayoutFaults& faults) {
    const std::array<vec2, 3> p = texel_corners(s, t);
    const auto g = float(gutter);
    for (vec2 q : p)
        faults.out_of_range += !(q.x >= g && q.x <= float(atlas.width) - g && q.y >= g &&
                                 q.y <= float(atlas.height) - g);
    double longest = 0;
    for (int i = 0; i < 3; ++i)
        longest = std::max(longest, double(length(s.corner(t, (i + 1) % 3) - s.corner(t, i))));
    const vec2 b = p[1] - p[0], c = p[2] - p[0];
    const bool flat = double(b.x) * double(c.y) == double(b.y) * double(c.x);
    faults.lost += flat && double(area(s, t)) > 1e-3 * longest * longest;
}

/// Points of a grid of quarter texels that lie inside two triangles.
inline int count_overlaps(const Surfaces& s, const Atlas& atlas) {
    constexpr int kFine = 4;          // points per texel and axis
    constexpr double kMargin = 0.01;  // texels; neighbours share edges up to rounding
    const int width = atlas.width * kFine, height = atlas.height * kFine;
    std::vector<char> hit(static_cast<size_t>(width) * static_cast<size_t>(height), 0);
    const auto cell = [](float f, int bound) {
        return std::clamp(static_cast<int>(std::floor(f * kFine)), 0, bound - 1);
    };
    int overlaps = 0;
    for (uint32_t t = 0; t < s.triangles.size(); ++t) {
        if (!(area(s, t) > 0)) continue;
        const auto [a, b, c] = texel_corners(s, t);
        const int x0 = cell(std::min({a.x, b.x, c.x}), width);
        const int x1 = cell(std::max({a.x, b.x, c.x}), width);
        const int y1 = cell(std::max({a.y, b.y, c.y}), height);
        for (int y = cell(std::min({a.y, b.y, c.y}), height); y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double px = (x + 0.5) / kFine, py = (y + 0.5) / kFine;
                if (inside_of(a, b, px, py) < kMargin || inside_of(b, c, px, py) < kMargin ||
                    inside_of(c, a, px, py) < kMargin)
                    continue;
                char& at = hit[static_cast<size_t>(y) * static_cast<size_t>(width) +
                               static_cast<size_t>(x)];
                overlaps += at;
                at = 1;
            }
    }
    return overlaps;
}

/// Covered texels with a texel of another chart no more than `gutter` texels away.
inline int count_near(const Surfaces& s, const Atlas& atlas, int gutter) {
    const std::vector<uint32_t> charts = charts_of(s);
    const Texels texels = rasterize(s, atlas, 1);
    const auto chart_at = [&](int x, int y) {
        const uint32_t e = texels.element_at[static_cast<size_t>(y * texels.width + x)];
        return e == kNoElement ? kNoElement
                               : charts[texels.samples[texels.first_sample[e]].triangle];
    };
    int count = 0;
    for (uint32_t pixel : texels.pixel_of) {
        const int x0 = int(pixel) % texels.width, y0 = int(pixel) / texels.width;
        const uint32_t own = chart_at(x0, y0);
        bool near = false;
        const int x1 = std::min(texels.width - 1, x0 + gutter);
        const int y1 = std::min(texels.height - 1, y0 + gutter);
        for (int y = std::max(0, y0 - gutter); y <= y1; ++y)
            for (int x = std::max(0, x0 - gutter); x <= x1; ++x)
                near = near || (chart_at(x, y) != kNoElement && chart_at(x, y) != own);
        count += near;
    }
    return count;
}

inline LayoutFaults find_faults(const Surfaces& s, const Atlas& atlas, int gutter) {
    LayoutFaults faults;
    for (uint32_t t = 0; t < s.triangles.size(); ++t)
        if (area(s, t) > 0) check_triangle(s, t, atlas, gutter, faults);
    faults.overlaps = count_overlaps(s, atlas);
    faults.near = count_near(s, atlas, gutter);
    return faults;
}

}  // namespace aglow::mesh::testing
