// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/segment.h"

#include "aglow/mesh/charts/borders.h"
#include "aglow/mesh/charts/merge.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace aglow::mesh {
namespace {

constexpr uint32_t kNone = kNoSegment;
/// Normals this close to the first one's make one flat region: 1 degree.
const double kFlat = std::cos(0.0175);

/// Flat regions of the listed triangles.
struct Facets {
    std::vector<uint32_t> of;  ///< [soup triangle] facet, or kNone where not listed
    std::vector<std::vector<uint32_t>> triangles;
    std::vector<Point3> normals;  ///< area-weighted mean, unit
    std::vector<double> areas;
};

Facets find_facets(const Soup& soup, std::span<const uint32_t> listed) {
    Facets facets;
    std::vector<char> wanted(soup.triangle_count(), 0);
    for (uint32_t t : listed) wanted[t] = soup.points_only[t] ? 0 : 1;
    facets.of.assign(soup.triangle_count(), kNone);
    for (uint32_t seed : listed) {
        if (!wanted[seed] || facets.of[seed] != kNone) continue;
        const auto facet = static_cast<uint32_t>(facets.triangles.size());
        std::vector<uint32_t> members = {seed};
        facets.of[seed] = facet;
        Point3 sum = soup.normals[seed] * soup.areas[seed];
        double area = soup.areas[seed];
        for (size_t head = 0; head < members.size(); ++head)
            for (int32_t n : soup.neighbors[members[head]]) {
                if (n < 0) continue;
                const auto next = static_cast<uint32_t>(n);
                if (!wanted[next] || facets.of[next] != kNone) continue;
                if (dot(soup.normals[next], soup.normals[seed]) < kFlat) continue;
                facets.of[next] = facet;
                members.push_back(next);
                sum = sum + soup.normals[next] * soup.areas[next];
                area += soup.areas[next];
            }
        const Point3 mean = unit(sum);
        facets.normals.push_back(length(mean) > 0 ? mean : soup.normals[seed]);
        facets.areas.push_back(area);
        facets.triangles.push_back(std::move(members));
    }
    return facets;
}

/// Facets beside each facet, across edges no sharper than the crease limit.
std::vector<std::vector<uint32_t>> facet_neighbors(const Soup& soup, const Facets& facets,
                                                   double crease) {
    const double least = std::cos(crease);
    std::vector<std::vector<uint32_t>> beside(facets.triangles.size());
    for (uint32_t f = 0; f < beside.size(); ++f) {
        for (uint32_t t : facets.triangles[f])
            for (int32_t n : soup.neighbors[t]) {
                if (n < 0) continue;
                const auto other = static_cast<uint32_t>(n);
                if (facets.of[other] == kNone || facets.of[other] == f) continue;
                if (dot(soup.normals[t], soup.normals[other]) >= least)
                    beside[f].push_back(facets.of[other]);
            }
        std::sort(beside[f].begin(), beside[f].end());
        beside[f].erase(std::unique(beside[f].begin(), beside[f].end()), beside[f].end());
    }
    return beside;
}

struct Candidate {
    double deviation;  ///< 1 - cosine to the segment's axis when it was queued
    uint32_t facet;
    bool operator>(const Candidate& other) const {
        return deviation != other.deviation ? deviation > other.deviation : facet > other.facet;
    }
};

/// Grows one segment from a seed, the facets that deviate least from its mean normal first.
void grow(const Facets& facets, const std::vector<std::vector<uint32_t>>& beside, uint32_t seed,
          double cone, uint32_t segment, std::vector<uint32_t>& segment_of) {
    const double least = std::cos(cone);
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    Point3 sum = facets.normals[seed] * facets.areas[seed];
    Point3 axis = facets.normals[seed];
    const auto take = [&](uint32_t facet) {
        segment_of[facet] = segment;
        for (uint32_t other : beside[facet])
            if (segment_of[other] == kNone)
                queue.push({1 - dot(facets.normals[other], axis), other});
    };
    take(seed);
    while (!queue.empty()) {
        const Candidate next = queue.top();
        queue.pop();
        if (segment_of[next.facet] != kNone) continue;
        const double cosine = dot(facets.normals[next.facet], axis);
        if (cosine < least) continue;
        sum = sum + facets.normals[next.facet] * facets.areas[next.facet];
        if (length(sum) > 0) axis = unit(sum);
        take(next.facet);
    }
}

std::vector<uint32_t> grow_all(const Facets& facets,
                               const std::vector<std::vector<uint32_t>>& beside, double cone,
                               uint32_t& count) {
    std::vector<uint32_t> by_area(facets.areas.size());
    std::iota(by_area.begin(), by_area.end(), 0u);
    std::stable_sort(by_area.begin(), by_area.end(),
                     [&](uint32_t a, uint32_t b) { return facets.areas[a] > facets.areas[b]; });
    std::vector<uint32_t> segment_of(facets.areas.size(), kNone);
    count = 0;
    for (uint32_t seed : by_area)
        if (segment_of[seed] == kNone) grow(facets, beside, seed, cone, count++, segment_of);
    return segment_of;
}

}  // namespace

std::vector<std::vector<uint32_t>> segment(const Soup& soup, std::span<const uint32_t> triangles,
                                           const SegmentLimits& limits) {
    const Facets facets = find_facets(soup, triangles);
    const auto beside = facet_neighbors(soup, facets, limits.crease);
    uint32_t count = 0;
    std::vector<uint32_t> segment_of = grow_all(facets, beside, limits.cone, count);

    std::vector<SegmentPatch> patches(facets.areas.size());
    for (size_t f = 0; f < patches.size(); ++f)
        patches[f] = {facets.normals[f], facets.areas[f], segment_of[f]};
    segment_of = merge_segments(patches, beside, count, limits.cone);

    std::vector<uint32_t> of_triangle(soup.triangle_count(), kNoSegment);
    std::vector<char> movable(soup.triangle_count(), 0);
    for (size_t f = 0; f < facets.triangles.size(); ++f)
        for (uint32_t t : facets.triangles[f]) {
            of_triangle[t] = segment_of[f];
            movable[t] = facets.triangles[f].size() == 1;  // flat regions stay whole
        }
    smooth_borders(soup, movable, limits.cone, of_triangle);
    return connected_segments(soup, of_triangle);
}

}  // namespace aglow::mesh
