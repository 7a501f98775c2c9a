// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/borders.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::mesh {
namespace {

std::vector<Point3> mean_normals(const Soup& soup, const std::vector<uint32_t>& segment_of) {
    std::vector<Point3> sums;
    for (size_t t = 0; t < segment_of.size(); ++t) {
        if (segment_of[t] == kNoSegment) continue;
        if (segment_of[t] >= sums.size()) sums.resize(segment_of[t] + 1);
        sums[segment_of[t]] = sums[segment_of[t]] + soup.normals[t] * soup.areas[t];
    }
    for (Point3& sum : sums) sum = unit(sum);
    return sums;
}

/// The segment with which triangle t shares the most border; its own where that is as good.
uint32_t closest_segment(const Soup& soup, const std::vector<uint32_t>& segment_of, uint32_t t) {
    std::array<uint32_t, 3> segments{kNoSegment, kNoSegment, kNoSegment};
    std::array<double, 3> lengths{};
    for (size_t i = 0; i < 3; ++i) {
        const int32_t n = soup.neighbors[t][i];
        if (n >= 0) segments[i] = segment_of[static_cast<size_t>(n)];
        lengths[i] = soup.edge_length(t, i);
    }
    const auto shared = [&](uint32_t segment) {
        double sum = 0;
        for (size_t i = 0; i < 3; ++i)
            if (segments[i] == segment) sum += lengths[i];
        return sum;
    };
    uint32_t best = segment_of[t];
    for (uint32_t s : segments)
        // The margin keeps a triangle between two equal borders from going to and fro.
        if (s != kNoSegment && shared(s) > 1.01 * shared(best)) best = s;
    return best;
}

}  // namespace

void smooth_borders(const Soup& soup, const std::vector<char>& movable, double cone,
                    std::vector<uint32_t>& segment_of) {
    constexpr int kSweeps = 4;
    const std::vector<Point3> axes = mean_normals(soup, segment_of);
    const double least = std::cos(cone);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        bool changed = false;
        for (uint32_t t = 0; t < segment_of.size(); ++t) {
            if (segment_of[t] == kNoSegment || !movable[t]) continue;
            const uint32_t best = closest_segment(soup, segment_of, t);
            if (best == segment_of[t] || dot(axes[best], soup.normals[t]) < least) continue;
            segment_of[t] = best;
            changed = true;
        }
        if (!changed) break;
    }
}

std::vector<std::vector<uint32_t>> connected_segments(const Soup& soup,
                                                      const std::vector<uint32_t>& segment_of) {
    std::vector<std::vector<uint32_t>> parts;
    std::vector<char> listed(segment_of.size(), 0);
    for (uint32_t seed = 0; seed < segment_of.size(); ++seed) {
        if (listed[seed] || segment_of[seed] == kNoSegment) continue;
        std::vector<uint32_t> part = {seed};
        listed[seed] = 1;
        for (size_t head = 0; head < part.size(); ++head)
            for (int32_t n : soup.neighbors[part[head]]) {
                if (n < 0 || listed[static_cast<size_t>(n)]) continue;
                const auto next = static_cast<uint32_t>(n);
                if (segment_of[next] != segment_of[seed]) continue;
                listed[next] = 1;
                part.push_back(next);
            }
        std::sort(part.begin(), part.end());
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace aglow::mesh
