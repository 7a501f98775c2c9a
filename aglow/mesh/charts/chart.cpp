// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace aglow::mesh {
namespace {

/// Convex hull, counter-clockwise without collinear corners.
/// Source  Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions", IPL 1979.
std::vector<Point2> convex_hull(std::vector<Point2> points) {
    std::sort(points.begin(), points.end(),
              [](Point2 a, Point2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    std::vector<Point2> hull;
    const auto extend = [&](auto begin, auto end) {
        const size_t base = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= base + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back();
    };
    if (points.size() < 3) return points;
    extend(points.begin(), points.end());
    extend(points.rbegin(), points.rend());
    return hull;
}

struct Extent {
    double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
    double area() const { return (x1 - x0) * (y1 - y0); }
    double perimeter() const { return (x1 - x0) + (y1 - y0); }
};

/// Coordinates along `direction` and to its left.
Point2 turned(Point2 p, Point2 direction) { return {dot(p, direction), cross(direction, p)}; }

Extent extent(const std::vector<Point2>& points, Point2 direction) {
    Extent e;
    for (const Point2& p : points) {
        const Point2 q = turned(p, direction);
        e.x0 = std::min(e.x0, q.x), e.x1 = std::max(e.x1, q.x);
        e.y0 = std::min(e.y0, q.y), e.y1 = std::max(e.y1, q.y);
    }
    return e;
}

/// Direction of a hull edge along which the box is smallest. A large hull (a disc's rim) is tried
/// at every k-th edge only, since its box hardly depends on the direction.
Point2 best_direction(const std::vector<Point2>& hull) {
    constexpr size_t kMostTried = 64;
    const size_t step = (hull.size() + kMostTried - 1) / kMostTried;
    Point2 best{1, 0};
    Extent best_extent = extent(hull, best);
    for (size_t i = 0; i < hull.size(); i += std::max<size_t>(1, step)) {
        const Point2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double norm = std::sqrt(dot(edge, edge));
        if (!(norm > 0)) continue;
        const Extent e = extent(hull, edge * (1 / norm));
        // The small margin keeps the first of equally good directions, whatever the rounding.
        if (e.area() < best_extent.area() * (1 - 1e-6) ||
            (e.area() <= best_extent.area() && e.perimeter() < best_extent.perimeter())) {
            best = edge * (1 / norm);
            best_extent = e;
        }
    }
    return best;
}

}  // namespace

Chart make_chart(const Soup& soup, std::vector<uint32_t> triangles) {
    Chart chart;
    chart.triangles = std::move(triangles);
    for (uint32_t t : chart.triangles)
        chart.points.insert(chart.points.end(), soup.triangles[t].begin(), soup.triangles[t].end());
    std::sort(chart.points.begin(), chart.points.end());
    chart.points.erase(std::unique(chart.points.begin(), chart.points.end()), chart.points.end());
    const auto local = [&](uint32_t point) {
        const auto at = std::lower_bound(chart.points.begin(), chart.points.end(), point);
        return static_cast<uint32_t>(at - chart.points.begin());
    };
    for (uint32_t t : chart.triangles) {
        const auto& c = soup.triangles[t];
        chart.corners.push_back({local(c[0]), local(c[1]), local(c[2])});
    }
    chart.uvs.assign(chart.points.size(), Point2{});
    return chart;
}

NormalCone normal_cone(const Soup& soup, std::span<const uint32_t> triangles) {
    Point3 sum;
    for (uint32_t t : triangles) sum = sum + soup.normals[t] * soup.areas[t];
    NormalCone cone{unit(sum), 0};
    if (length(cone.axis) == 0 && !triangles.empty()) cone.axis = soup.normals[triangles[0]];
    for (uint32_t t : triangles)
        cone.angle =
            std::max(cone.angle, std::acos(std::clamp(dot(soup.normals[t], cone.axis), -1.0, 1.0)));
    return cone;
}

void project(const Soup& soup, Point3 axis, Chart& chart) {
    if (length(axis) == 0) axis = {0, 0, 1};
    const Point3 other = std::abs(axis.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
    const Point3 tangent = unit(cross(other, axis));
    const Point3 bitangent = cross(axis, tangent);
    const Point3 origin = soup.points[chart.points[0]];
    for (size_t i = 0; i < chart.points.size(); ++i) {
        const Point3 p = soup.points[chart.points[i]] - origin;
        chart.uvs[i] = {dot(p, tangent), dot(p, bitangent)};
    }
    double flat = 0, true_area = 0;
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        flat += std::abs(doubled_area(chart.triangle(i))) / 2;
        true_area += soup.areas[chart.triangles[i]];
    }
    if (!(flat > 0)) return;
    const double scale = std::sqrt(true_area / flat);
    for (Point2& uv : chart.uvs) uv = uv * scale;
}

void fit_box(Chart& chart) {
    const std::vector<Point2> hull = convex_hull(chart.uvs);
    Point2 direction = best_direction(hull);
    Extent box = extent(hull, direction);
    if (box.x1 - box.x0 > box.y1 - box.y0) {
        direction = {-direction.y, direction.x};
        box = extent(hull, direction);
    }
    for (Point2& uv : chart.uvs) {
        const Point2 q = turned(uv, direction);
        uv = {std::max(0.0, q.x - box.x0), std::max(0.0, q.y - box.y0)};
    }
    chart.width = box.x1 - box.x0;
    chart.height = box.y1 - box.y0;
}

}  // namespace aglow::mesh
