// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/merge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace aglow::mesh {
namespace {

/// What is known of a growing union: enough to bound its normals without visiting its patches.
struct Union {
    Point3 sum;  ///< area-weighted normals
    double area = 0;
    std::map<uint32_t, Point3> normals;   ///< one representative per direction bin
    std::map<uint32_t, double> touching;  ///< other segment -> number of shared patch borders
};

/// Bin of a direction on an octahedral map of 24 x 24 cells, each about 5 degrees wide.
/// Source  Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors",
/// JCGT 2014.
uint32_t direction_bin(Point3 n) {
    const double norm = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(norm > 0)) return 0;
    double u = n.x / norm, v = n.y / norm;
    if (n.z < 0) {
        const double folded = (1 - std::abs(v)) * (u >= 0 ? 1 : -1);
        v = (1 - std::abs(u)) * (v >= 0 ? 1 : -1);
        u = folded;
    }
    constexpr int kCells = 24;
    const int x = std::clamp(static_cast<int>((u + 1) / 2 * kCells), 0, kCells - 1);
    const int y = std::clamp(static_cast<int>((v + 1) / 2 * kCells), 0, kCells - 1);
    return static_cast<uint32_t>(y * kCells + x);
}

bool union_fits(const Union& a, const Union& b, double least_cosine) {
    const Point3 axis = unit(a.sum + b.sum);
    const auto within = [&](const Union& part) {
        return std::all_of(part.normals.begin(), part.normals.end(), [&](const auto& normal) {
            return dot(normal.second, axis) >= least_cosine;
        });
    };
    return within(a) && within(b);
}

uint32_t find_root(std::vector<uint32_t>& parent, uint32_t s) {
    while (parent[s] != s) s = parent[s] = parent[parent[s]];
    return s;
}

std::vector<Union> collect(const std::vector<SegmentPatch>& patches,
                           const std::vector<std::vector<uint32_t>>& beside, uint32_t count) {
    std::vector<Union> unions(count);
    for (size_t p = 0; p < patches.size(); ++p) {
        const SegmentPatch& patch = patches[p];
        Union& u = unions[patch.segment];
        u.sum = u.sum + patch.normal * patch.area;
        u.area += patch.area;
        u.normals.emplace(direction_bin(patch.normal), patch.normal);
        for (uint32_t other : beside[p])
            if (patches[other].segment != patch.segment)
                u.touching[patches[other].segment] +=
                    std::sqrt(std::min(patch.area, patches[other].area));
    }
    return unions;
}

/// The neighbour that shares the longest border with `s` and fits it; `s` itself where none does.
uint32_t best_partner(const std::vector<Union>& unions, std::vector<uint32_t>& parent, uint32_t s,
                      double least_cosine) {
    std::map<uint32_t, double> contact;
    for (const auto& [other, border] : unions[s].touching) {
        const uint32_t root = find_root(parent, other);
        if (root != s) contact[root] += border;
    }
    uint32_t best = s;
    double longest = -1;
    for (const auto& [other, border] : contact)
        if (border > longest && union_fits(unions[s], unions[other], least_cosine)) {
            best = other;
            longest = border;
        }
    return best;
}

void absorb(Union& into, Union& from) {
    into.sum = into.sum + from.sum;
    into.area += from.area;
    into.normals.merge(from.normals);
    for (const auto& [other, border] : from.touching) into.touching[other] += border;
    from = {};
}

}  // namespace

std::vector<uint32_t> merge_segments(const std::vector<SegmentPatch>& patches,
                                     const std::vector<std::vector<uint32_t>>& beside,
                                     uint32_t segment_count, double cone) {
    std::vector<Union> unions = collect(patches, beside, segment_count);
    std::vector<uint32_t> parent(segment_count);
    std::iota(parent.begin(), parent.end(), 0u);
    using Entry = std::pair<double, uint32_t>;  // area, segment
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (uint32_t s = 0; s < segment_count; ++s) queue.emplace(unions[s].area, s);
    while (!queue.empty()) {
        const auto [area, s] = queue.top();
        queue.pop();
        if (find_root(parent, s) != s || area != unions[s].area) continue;
        const uint32_t partner = best_partner(unions, parent, s, std::cos(cone));
        if (partner == s) continue;
        parent[s] = partner;
        absorb(unions[partner], unions[s]);
        queue.emplace(unions[partner].area, partner);
    }
    std::vector<uint32_t> segment_of(patches.size());
    for (size_t p = 0; p < patches.size(); ++p)
        segment_of[p] = find_root(parent, patches[p].segment);
    return segment_of;
}

}  // namespace aglow::mesh
