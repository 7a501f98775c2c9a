// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/make_charts.h"

#include "aglow/mesh/charts/segment.h"
#include "aglow/mesh/charts/validity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aglow::mesh {
namespace {

/// Cones of successive attempts, radians (55, 32, 17 and 8 degrees).
constexpr std::array<double, 4> kCones = {0.96, 0.56, 0.30, 0.14};
/// A projection along the mean normal stretches by 1 / cos: 2 % at this cone, less than a
/// conformal map would gain.
constexpr double kProjectable = 0.2;
/// Larger charts are split before they are flattened: the solve grows faster than linearly.
constexpr size_t kMostSolved = 120'000;

bool is_valid(const Soup& soup, const Chart& chart) {
    return stretch_is_bounded(soup, chart, {}) && !overlaps_itself(chart);
}

/// Lays a segment flat, or says that it must be split.
bool flatten(const Soup& soup, Chart& chart) {
    const NormalCone cone = normal_cone(soup, chart.triangles);
    if (cone.angle > kProjectable && chart.triangles.size() <= kMostSolved &&
        flatten_conformally(soup, chart) && is_valid(soup, chart))
        return true;
    project(soup, cone.axis, chart);
    return is_valid(soup, chart);
}

/// The last resort: charts that take their triangles one by one, neighbour by neighbour, as long
/// as the chart stays valid. A single triangle always is. Only charts of few triangles are tried.
std::vector<Chart> collect_singly(const Soup& soup, const std::vector<uint32_t>& triangles) {
    constexpr size_t kMostTriangles = 64;
    std::vector<char> waiting(soup.triangle_count(), 0);
    for (uint32_t t : triangles) waiting[t] = 1;
    std::vector<Chart> charts;
    for (uint32_t seed : triangles) {
        if (!waiting[seed]) continue;
        waiting[seed] = 0;
        std::vector<uint32_t> members = {seed};
        Chart accepted = make_chart(soup, members);
        // A sliver's own plane, however noisy, keeps what area it has.
        const Point3 ab = soup.corner(seed, 1) - soup.corner(seed, 0);
        project(soup, unit(cross(ab, soup.corner(seed, 2) - soup.corner(seed, 0))), accepted);
        for (size_t head = 0; head < members.size() && members.size() < kMostTriangles; ++head)
            for (int32_t n : soup.neighbors[members[head]]) {
                if (n < 0 || !waiting[static_cast<size_t>(n)]) continue;
                members.push_back(static_cast<uint32_t>(n));
                Chart larger = make_chart(soup, members);
                if (flatten(soup, larger)) {
                    accepted = std::move(larger);
                    waiting[static_cast<size_t>(n)] = 0;
                } else {
                    members.pop_back();
                }
            }
        charts.push_back(std::move(accepted));
    }
    return charts;
}

}  // namespace

std::optional<std::vector<Chart>> make_charts(const Soup& soup, const Monitor& monitor) {
    std::vector<uint32_t> waiting(soup.triangle_count());
    std::iota(waiting.begin(), waiting.end(), 0u);
    std::vector<Chart> charts;
    for (const double cone : kCones) {
        std::vector<uint32_t> refused;
        for (auto& members : segment(soup, waiting, {cone})) {
            if (monitor.cancelled()) return std::nullopt;
            Chart chart = make_chart(soup, std::move(members));
            if (flatten(soup, chart))
                charts.push_back(std::move(chart));
            else
                refused.insert(refused.end(), chart.triangles.begin(), chart.triangles.end());
        }
        std::sort(refused.begin(), refused.end());
        waiting = std::move(refused);
        if (waiting.empty()) break;
    }
    for (Chart& chart : collect_singly(soup, waiting)) charts.push_back(std::move(chart));
    for (Chart& chart : charts) fit_box(chart);
    return charts;
}

}  // namespace aglow::mesh
