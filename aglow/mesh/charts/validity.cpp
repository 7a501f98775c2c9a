// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/validity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace aglow::mesh {
namespace {

struct Bounds {
    Point2 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Point2 hi{-lo.x, -lo.y};
    void add(Point2 p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    double size() const { return std::max(hi.x - lo.x, hi.y - lo.y); }
};

struct Segment {
    Point2 a, b;
    uint32_t ia, ib;  ///< uv indices
};

/// Edges that belong to one triangle only.
std::vector<Segment> border(const Chart& chart) {
    std::vector<std::tuple<uint32_t, uint32_t>> edges;
    for (const auto& c : chart.corners)
        for (size_t i = 0; i < 3; ++i)
            edges.emplace_back(std::min(c[i], c[(i + 1) % 3]), std::max(c[i], c[(i + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    std::vector<Segment> segments;
    for (size_t i = 0; i < edges.size();) {
        size_t end = i + 1;
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        const auto [a, b] = edges[i];
        if (end - i == 1) segments.push_back({chart.uvs[a], chart.uvs[b], a, b});
        i = end;
    }
    return segments;
}

/// Whether two segments without a common end cross by more than `slack`.
bool cross_over(const Segment& s, const Segment& t, double slack) {
    if (s.ia == t.ia || s.ia == t.ib || s.ib == t.ia || s.ib == t.ib) return false;
    const auto sides = [&](const Segment& line, const Segment& other) {
        const Point2 along = line.b - line.a;
        const double norm = std::sqrt(dot(along, along));
        if (!(norm > 0)) return false;
        const double da = cross(along, other.a - line.a) / norm;
        const double db = cross(along, other.b - line.a) / norm;
        return (da > slack && db < -slack) || (da < -slack && db > slack);
    };
    return sides(s, t) && sides(t, s);
}

/// Segments by cells of a uniform grid, about one segment per cell.
class SegmentGrid {
public:
    SegmentGrid(const std::vector<Segment>& segments, const Bounds& bounds)
        : origin_(bounds.lo),
          side_(std::clamp(static_cast<int>(std::sqrt(double(segments.size()))), 1, 1024)),
          scale_(side_ / std::max(bounds.size(), std::numeric_limits<double>::min())) {
        for (uint32_t i = 0; i < segments.size(); ++i)
            for_each_cell(segments[i], [&](int cell) { entries_.emplace_back(cell, i); });
        std::sort(entries_.begin(), entries_.end());
    }

    /// Calls visit(i, j) for pairs of segments that share a cell until it returns true.
    template <class Visit>
    bool any_pair(Visit visit) const {
        for (size_t begin = 0; begin < entries_.size();) {
            size_t end = begin;
            while (end < entries_.size() && entries_[end].first == entries_[begin].first) ++end;
            for (size_t i = begin; i < end; ++i)
                for (size_t j = i + 1; j < end; ++j)
                    if (visit(entries_[i].second, entries_[j].second)) return true;
            begin = end;
        }
        return false;
    }

private:
    /// Cells that the segment passes, row by row.
    template <class Visit>
    void for_each_cell(const Segment& s, Visit visit) const {
        Point2 a = (s.a - origin_) * scale_, b = (s.b - origin_) * scale_;
        if (a.y > b.y) std::swap(a, b);
        const auto cell = [&](double v) {
            return std::clamp(static_cast<int>(std::floor(v)), 0, side_ - 1);
        };
        for (int y = cell(a.y); y <= cell(b.y); ++y) {
            const double dy = b.y - a.y;
            const auto at = [&](double row) {
                const double t = dy > 0 ? std::clamp((row - a.y) / dy, 0.0, 1.0) : 0.0;
                return a.x + (b.x - a.x) * t;
            };
            double x0 = at(y), x1 = dy > 0 ? at(y + 1) : b.x;
            if (x0 > x1) std::swap(x0, x1);
            for (int x = cell(x0); x <= cell(x1); ++x) visit(y * side_ + x);
        }
    }

    Point2 origin_;
    int side_;
    double scale_;
    std::vector<std::pair<int, uint32_t>> entries_;
};

bool border_crosses_itself(const Chart& chart) {
    const std::vector<Segment> segments = border(chart);
    Bounds bounds;
    for (const Segment& s : segments) bounds.add(s.a), bounds.add(s.b);
    if (segments.size() < 4) return false;
    // Two borders that touch within rounding do not cross: 1e-9 of the chart is far below a texel.
    const double slack = 1e-9 * bounds.size();
    const SegmentGrid grid(segments, bounds);
    return grid.any_pair(
        [&](uint32_t i, uint32_t j) { return cross_over(segments[i], segments[j], slack); });
}

/// Calls visit(x, y) for grid centres at least `margin` inside a counter-clockwise triangle.
template <class Visit>
bool any_center_inside(const Triangle2& t, int resolution, double margin, Visit visit) {
    Bounds box;
    for (const Point2& p : t) box.add(p);
    const auto clamp = [&](double v) { return std::clamp(static_cast<int>(v), 0, resolution - 1); };
    for (int y = clamp(box.lo.y - 0.5); y <= clamp(box.hi.y); ++y) {
        // The row's interval of x where all three edge functions exceed the margin.
        double lo = box.lo.x, hi = box.hi.x;
        bool empty = false;
        for (size_t i = 0; i < 3; ++i) {
            const Point2 edge = t[(i + 1) % 3] - t[i];
            const double norm = std::sqrt(dot(edge, edge));
            // edge.x * (y - ay) - edge.y * (x - ax) >= margin * norm
            const double rest = edge.x * (y + 0.5 - t[i].y) + edge.y * t[i].x - margin * norm;
            if (edge.y > 0)
                hi = std::min(hi, rest / edge.y);
            else if (edge.y < 0)
                lo = std::max(lo, rest / edge.y);
            else if (rest < 0)
                empty = true;
        }
        if (empty) continue;
        for (int x = std::max(0, static_cast<int>(std::ceil(lo - 0.5)));
             x <= std::min(resolution - 1, static_cast<int>(std::floor(hi - 0.5))); ++x)
            if (visit(x, y)) return true;
    }
    return false;
}

}  // namespace

Stretch stretch_of(const Soup& soup, uint32_t triangle, const Triangle2& flat) {
    const Point3 ab = soup.corner(triangle, 1) - soup.corner(triangle, 0);
    const Point3 ac = soup.corner(triangle, 2) - soup.corner(triangle, 0);
    const double base = length(ab), area = length(cross(ab, ac));
    if (!(base > 0) || !(area > 0)) return {};
    const double x = dot(ab, ac) / base, y = area / base;
    // Jacobian of the map from the triangle's plane, columns du and dv.
    const Point2 du = (flat[1] - flat[0]) * (1 / base);
    const Point2 dv = ((flat[2] - flat[0]) - du * x) * (1 / y);
    const double determinant = cross(du, dv), squares = dot(du, du) + dot(dv, dv);
    const double half = std::sqrt(std::max(0.0, squares * squares / 4 - determinant * determinant));
    const double largest = std::sqrt(squares / 2 + half);
    const double smallest = largest > 0 ? std::abs(determinant) / largest : 0;
    const double scale = std::sqrt(std::abs(determinant));
    return {determinant < 0 ? -scale : scale,
            smallest > 0 ? largest / smallest : std::numeric_limits<double>::infinity()};
}

bool stretch_is_bounded(const Soup& soup, const Chart& chart, const StretchLimits& limits) {
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        const uint32_t t = chart.triangles[i];
        if (soup.slivers[t]) continue;
        const Stretch stretch = stretch_of(soup, t, chart.triangle(i));
        if (!(stretch.scale * limits.scale >= 1) || stretch.scale > limits.scale ||
            stretch.aspect > limits.aspect)
            return false;
    }
    return true;
}

bool any_overlap(const std::vector<Triangle2>& triangles, int resolution) {
    Bounds bounds;
    for (const Triangle2& t : triangles)
        for (const Point2& p : t) bounds.add(p);
    if (triangles.size() < 2 || !(bounds.size() > 0)) return false;
    const double scale = resolution / bounds.size();
    // Neighbours share an edge up to the rounding of float UVs; a centre must be clearly inside.
    constexpr double kMargin = 0.05;
    std::vector<char> taken(static_cast<size_t>(resolution) * static_cast<size_t>(resolution), 0);
    for (const Triangle2& t : triangles) {
        Triangle2 cells;
        for (size_t i = 0; i < 3; ++i) cells[i] = (t[i] - bounds.lo) * scale;
        if (doubled_area(cells) < 0) std::swap(cells[1], cells[2]);
        if (any_center_inside(cells, resolution, kMargin, [&](int x, int y) {
                char& cell = taken[static_cast<size_t>(y) * static_cast<size_t>(resolution) +
                                   static_cast<size_t>(x)];
                const bool again = cell != 0;
                cell = 1;
                return again;
            }))
            return true;
    }
    return false;
}

bool overlaps_itself(const Chart& chart) {
    if (chart.triangles.size() < 2) return false;
    if (border_crosses_itself(chart)) return true;
    std::vector<Triangle2> triangles;
    for (size_t i = 0; i < chart.triangles.size(); ++i) triangles.push_back(chart.triangle(i));
    const double cells = 4 * std::sqrt(double(chart.triangles.size()));
    return any_overlap(triangles, std::clamp(static_cast<int>(cells), 64, 1024));
}

}  // namespace aglow::mesh
