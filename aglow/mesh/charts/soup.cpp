// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/soup.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace aglow::mesh {
namespace {

auto key(const Point3& p) { return std::tie(p.x, p.y, p.z); }

/// Number of the welded point of every position; fills soup.points.
std::vector<uint32_t> weld(const std::vector<Point3>& positions, Soup& soup) {
    std::vector<uint32_t> order(positions.size()), welded(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const auto ka = key(positions[a]), kb = key(positions[b]);
        return ka != kb ? ka < kb : a < b;
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const Point3& p = positions[order[i]];
        if (i == 0 || key(p) != key(positions[order[i - 1]])) soup.points.push_back(p);
        welded[order[i]] = static_cast<uint32_t>(soup.points.size() - 1);
    }
    return welded;
}

struct HalfEdge {
    uint32_t low, high;  ///< welded ends
    uint32_t triangle;
    uint8_t side;
    bool forward;  ///< runs from low to high

    bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const Soup& soup) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * soup.triangle_count());
    for (uint32_t t = 0; t < soup.triangle_count(); ++t) {
        if (soup.points_only[t]) continue;
        for (uint8_t i = 0; i < 3; ++i) {
            const uint32_t a = soup.triangles[t][i], b = soup.triangles[t][(i + 1u) % 3u];
            edges.push_back({std::min(a, b), std::max(a, b), t, i, a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.side) <
               std::tie(b.low, b.high, b.triangle, b.side);
    });
    return edges;
}

void join(Soup& soup, const HalfEdge& a, const HalfEdge& b) {
    soup.neighbors[a.triangle][a.side] = static_cast<int32_t>(b.triangle);
    soup.neighbors[b.triangle][b.side] = static_cast<int32_t>(a.triangle);
}

/// Pairs the half-edges of one edge: opposite directions only, smoothest continuation first.
void pair_half_edges(Soup& soup, const HalfEdge* first, size_t count) {
    if (count == 2) {
        if (first[0].forward != first[1].forward) join(soup, first[0], first[1]);
        return;
    }
    // Hubs of very many triangles have no meaningful neighbours, and pairing is quadratic.
    constexpr size_t kMost = 16;
    if (count < 2 || count > kMost) return;
    struct Pair {
        double smoothness;
        size_t a, b;
    };
    std::vector<Pair> pairs;
    for (size_t a = 0; a < count; ++a)
        for (size_t b = a + 1; b < count; ++b)
            if (first[a].forward != first[b].forward)
                pairs.push_back(
                    {dot(soup.normals[first[a].triangle], soup.normals[first[b].triangle]), a, b});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& p, const Pair& q) { return p.smoothness > q.smoothness; });
    std::array<bool, kMost> used{};
    for (const Pair& p : pairs) {
        if (used[p.a] || used[p.b]) continue;
        used[p.a] = used[p.b] = true;
        join(soup, first[p.a], first[p.b]);
    }
}

void find_neighbors(Soup& soup) {
    soup.neighbors.assign(soup.triangle_count(), {-1, -1, -1});
    const std::vector<HalfEdge> edges = sorted_half_edges(soup);
    for (size_t begin = 0; begin < edges.size();) {
        size_t end = begin + 1;
        while (end < edges.size() && edges[end].same_edge(edges[begin])) ++end;
        pair_half_edges(soup, &edges[begin], end - begin);
        begin = end;
    }
}

size_t longest_edge(const Soup& soup, uint32_t t) {
    size_t longest = 0;
    for (size_t i = 1; i < 3; ++i)
        if (soup.edge_length(t, i) > soup.edge_length(t, longest)) longest = i;
    return longest;
}

/// Hands normals from trusted triangles on to slivers: along chains of longest edges where these
/// end at a trusted triangle, else from whatever neighbour has one first.
void lend_normals(Soup& soup) {
    std::vector<char> known(soup.triangle_count());
    for (size_t t = 0; t < known.size(); ++t) known[t] = soup.slivers[t] ? 0 : 1;
    std::vector<uint32_t> chain;
    for (uint32_t t = 0; t < soup.triangle_count(); ++t) {
        if (known[t] || soup.points_only[t]) continue;
        // Two slivers that share their longest edge point at each other: short chains suffice.
        constexpr size_t kLongestChain = 64;
        chain.clear();
        int32_t at = static_cast<int32_t>(t);
        while (at >= 0 && !known[static_cast<size_t>(at)] && chain.size() < kLongestChain) {
            const auto link = static_cast<uint32_t>(at);
            chain.push_back(link);
            at = soup.neighbors[link][longest_edge(soup, link)];
        }
        if (at < 0 || !known[static_cast<size_t>(at)]) continue;
        for (uint32_t link : chain) {
            soup.normals[link] = soup.normals[static_cast<size_t>(at)];
            known[link] = 1;
        }
    }
    std::vector<uint32_t> queue;
    for (uint32_t t = 0; t < soup.triangle_count(); ++t)
        if (known[t]) queue.push_back(t);
    for (size_t head = 0; head < queue.size(); ++head)
        for (int32_t neighbor : soup.neighbors[queue[head]]) {
            if (neighbor < 0 || known[static_cast<size_t>(neighbor)]) continue;
            known[static_cast<size_t>(neighbor)] = 1;
            soup.normals[static_cast<size_t>(neighbor)] = soup.normals[queue[head]];
            queue.push_back(static_cast<uint32_t>(neighbor));
        }
}

}  // namespace

double length(Point3 a) { return std::sqrt(dot(a, a)); }

Point3 unit(Point3 a) {
    const double norm = length(a);
    return norm > 0 ? a * (1 / norm) : Point3{};
}

Soup make_soup(const std::vector<Point3>& positions, const std::vector<uvec3>& triangles) {
    Soup soup;
    const std::vector<uint32_t> welded = weld(positions, soup);
    for (const uvec3& t : triangles) {
        const std::array<uint32_t, 3> corners = {welded[t.x], welded[t.y], welded[t.z]};
        const Point3 &a = soup.points[corners[0]], &b = soup.points[corners[1]],
                     &c = soup.points[corners[2]];
        const Point3 doubled = cross(b - a, c - a);
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        soup.triangles.push_back(corners);
        soup.normals.push_back(unit(doubled));
        soup.areas.push_back(length(doubled) / 2);
        soup.slivers.push_back(length(doubled) < kSliverHeight * longest * longest || longest == 0);
        soup.points_only.push_back(corners[0] == corners[1] || corners[1] == corners[2] ||
                                   corners[2] == corners[0]);
    }
    find_neighbors(soup);
    lend_normals(soup);
    return soup;
}

}  // namespace aglow::mesh
