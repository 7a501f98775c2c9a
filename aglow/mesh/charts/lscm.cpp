// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/chart.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cmath>
#include <new>

namespace aglow::mesh {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Entries = std::vector<Eigen::Triplet<double, int>>;

size_t farthest_from(const Soup& soup, const Chart& chart, Point3 from) {
    size_t best = 0;
    double farthest = -1;
    for (size_t i = 0; i < chart.points.size(); ++i) {
        const double d = length(soup.points[chart.points[i]] - from);
        if (d > farthest) best = i, farthest = d;
    }
    return best;
}

/// The triangle's corners in its own plane, first corner at the origin.
Triangle2 in_own_plane(const Soup& soup, uint32_t t) {
    const Point3 ab = soup.corner(t, 1) - soup.corner(t, 0);
    const Point3 ac = soup.corner(t, 2) - soup.corner(t, 0);
    const double base = length(ab);
    return {Point2{0, 0}, Point2{base, 0},
            Point2{dot(ab, ac) / base, length(cross(ab, ac)) / base}};
}

/// The unknowns are u of every free point, then v of every free point; two points are pinned.
struct Unknowns {
    std::vector<int> index;  ///< [uv] or -1 where pinned
    int count = 0;
    size_t pins[2] = {0, 0};
    Point2 pinned[2];
};

Unknowns number_unknowns(const Soup& soup, const Chart& chart) {
    Unknowns unknowns;
    Point3 center;
    for (uint32_t p : chart.points) center = center + soup.points[p];
    center = center * (1.0 / static_cast<double>(chart.points.size()));
    unknowns.pins[0] = farthest_from(soup, chart, center);
    const Point3 first = soup.points[chart.points[unknowns.pins[0]]];
    unknowns.pins[1] = farthest_from(soup, chart, first);
    const Point3 second = soup.points[chart.points[unknowns.pins[1]]];
    unknowns.pinned[1] = {length(second - first), 0};
    unknowns.index.assign(chart.points.size(), -1);
    for (size_t i = 0; i < chart.points.size(); ++i)
        if (i != unknowns.pins[0] && i != unknowns.pins[1]) unknowns.index[i] = unknowns.count++;
    return unknowns;
}

/// Adds the squares of both Cauchy-Riemann equations of one triangle to the normal equations.
void add_triangle(const Triangle2& plane, const std::array<uint32_t, 3>& corners,
                  const Unknowns& unknowns, Entries& entries, Eigen::VectorXd& right) {
    const double doubled = doubled_area(plane);
    const double longest = std::max({dot(plane[1], plane[1]), dot(plane[2], plane[2])});
    // The weight of a sliver is bounded, or its rounding noise would outweigh all others.
    const double weight = 1 / std::max(doubled, kSliverHeight * longest);
    // Row 0: sum(a u - b v), row 1: sum(b u + a v), with (a, b) the edge opposite each corner.
    struct Term {
        int column;
        double coefficient[2];
        double known;
    };
    std::array<Term, 6> terms;
    for (size_t i = 0; i < 3; ++i) {
        const Point2 edge = plane[(i + 2) % 3] - plane[(i + 1) % 3];
        const int column = unknowns.index[corners[i]];
        const Point2 pin =
            column >= 0 ? Point2{} : unknowns.pinned[corners[i] == unknowns.pins[0] ? 0 : 1];
        terms[2 * i] = {column, {edge.x, edge.y}, pin.x};
        terms[2 * i + 1] = {column < 0 ? -1 : column + unknowns.count, {-edge.y, edge.x}, pin.y};
    }
    for (const Term& row : terms) {
        if (row.column < 0) continue;
        for (const Term& other : terms) {
            const double product = weight * (row.coefficient[0] * other.coefficient[0] +
                                             row.coefficient[1] * other.coefficient[1]);
            if (other.column >= 0)
                entries.emplace_back(row.column, other.column, product);
            else
                right[row.column] -= product * other.known;
        }
    }
}

bool scale_to_area(const Soup& soup, Chart& chart) {
    double flat = 0, true_area = 0;
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        flat += doubled_area(chart.triangle(i)) / 2;
        true_area += soup.areas[chart.triangles[i]];
    }
    if (!(flat > 0) || !std::isfinite(flat)) return false;
    const double scale = std::sqrt(true_area / flat);
    for (Point2& uv : chart.uvs) uv = uv * scale;
    return true;
}

bool solve(const Soup& soup, Chart& chart) {
    const Unknowns unknowns = number_unknowns(soup, chart);
    Entries entries;
    entries.reserve(36 * chart.triangles.size());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * unknowns.count);
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        const uint32_t t = chart.triangles[i];
        if (soup.edge_length(t, 0) > 0)
            add_triangle(in_own_plane(soup, t), chart.corners[i], unknowns, entries, right);
    }
    SparseMatrix normal(2 * unknowns.count, 2 * unknowns.count);
    normal.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<SparseMatrix> factors(normal);
    if (factors.info() != Eigen::Success) return false;
    const Eigen::VectorXd solution = factors.solve(right);
    if (factors.info() != Eigen::Success || !solution.allFinite()) return false;
    for (size_t i = 0; i < chart.uvs.size(); ++i) {
        const int index = unknowns.index[i];
        chart.uvs[i] = index >= 0 ? Point2{solution[index], solution[index + unknowns.count]}
                                  : unknowns.pinned[i == unknowns.pins[0] ? 0 : 1];
    }
    return scale_to_area(soup, chart);
}

}  // namespace

bool flatten_conformally(const Soup& soup, Chart& chart) {
    if (chart.points.size() < 4) return false;
    try {
        return solve(soup, chart);
    } catch (const std::bad_alloc&) {
        return false;  // the chart is split into smaller ones, which need less
    }
}

}  // namespace aglow::mesh
