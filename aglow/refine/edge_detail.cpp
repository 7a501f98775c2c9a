// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/edge_detail.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/pattern.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace aglow {
namespace {

constexpr size_t kGrain = 64;              // faces
constexpr float kFinerThanTexels = 0.25f;  // of the error, for each doubling beyond texels

float texels_between(const HeightMap& map, vec2 a, vec2 b) {
    return std::hypot((b.x - a.x) * static_cast<float>(map.levels.width),
                      (b.y - a.y) * static_cast<float>(map.levels.height));
}

/// Heights of a face's pattern of some segments, row by row of equal j.
class Grid {
public:
    Grid(const HeightMap& map, const vec2 (&uv)[3], uint32_t segments, float texels)
        : segments_(segments) {
        const float n = static_cast<float>(segments);
        const float level = std::log2(std::max(texels / n, 1.0f));
        for (uint32_t j = 0; j <= segments; ++j)
            for (uint32_t i = 0; i + j <= segments; ++i) {
                const float x = static_cast<float>(i) / n, y = static_cast<float>(j) / n;
                heights_.push_back(sample(map, uv[0] * (1 - x - y) + uv[1] * x + uv[2] * y, level));
            }
    }
    float at(uint32_t i, uint32_t j) const { return heights_[j * (2 * segments_ + 3 - j) / 2 + i]; }
    uint32_t segments() const { return segments_; }

    /// On the triangles between the vertices, at steps of a pattern `finer` times as fine.
    float between(uint32_t i, uint32_t j, uint32_t finer) const {
        const uint32_t column = i / finer, row = j / finer;
        const float x = static_cast<float>(i % finer) / static_cast<float>(finer);
        const float y = static_cast<float>(j % finer) / static_cast<float>(finer);
        if (x + y <= 1) {
            float height = at(column, row) * (1 - x - y);
            if (x > 0) height += at(column + 1, row) * x;
            if (y > 0) height += at(column, row + 1) * y;
            return height;
        }
        return at(column + 1, row + 1) * (x + y - 1) + at(column, row + 1) * (1 - x) +
               at(column + 1, row) * (1 - y);
    }

private:
    uint32_t segments_;
    std::vector<float> heights_;
};

float largest_difference(const Grid& fine, const Grid& coarse) {
    const uint32_t n = fine.segments(), finer = n / coarse.segments();
    float worst = 0;
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i + j <= n; ++i)
            worst = std::max(worst, std::fabs(fine.at(i, j) - coarse.between(i, j, finer)));
    return worst;
}

EdgeDetail face_detail(const DetailSource& source, const vec2 (&uv)[3]) {
    float texels = 0;
    for (int i = 0; i < 3; ++i)
        texels = std::max(texels, texels_between(*source.map, uv[i], uv[(i + 1) % 3]));
    const auto needed = static_cast<uint32_t>(std::ceil(std::min<float>(texels, 128)));
    const uint32_t segments = std::clamp(std::bit_ceil(needed), 2u, 128u);
    const Grid fine(*source.map, uv, segments, texels);
    EdgeDetail detail = {};
    for (size_t k = 0; k < detail.size(); ++k) {
        const uint32_t coarse = 1u << k;
        detail[k] =
            coarse < segments
                ? largest_difference(fine, Grid(*source.map, uv, coarse, texels)) * source.scale
                : detail[k - 1] * kFinerThanTexels;
    }
    // Segments that happen to meet the heights of a coarser pattern are no worse with more.
    for (size_t k = detail.size() - 1; k-- > 0;) detail[k] = std::max(detail[k], detail[k + 1]);
    return detail;
}

}  // namespace

std::vector<EdgeDetail> edge_details(const Topology& topology, std::span<const vec2> uvs,
                                     std::span<const uint32_t> source_of,
                                     std::span<const DetailSource> sources) {
    AG_ASSERT(uvs.size() == topology.half_edge_count(), "coordinates for every corner");
    AG_ASSERT(source_of.size() == topology.vertex_count(), "a source for every vertex");
    std::vector<EdgeDetail> of_faces(topology.face_count(), EdgeDetail{});
    parallel_for(of_faces.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const uint32_t h = topology.face_begin[f];
            const DetailSource& source = sources[source_of[topology.vertex[h]]];
            if (source.map) of_faces[f] = face_detail(source, {uvs[h], uvs[h + 1], uvs[h + 2]});
        }
    });
    std::vector<EdgeDetail> details(topology.edge_count());
    for (size_t e = 0; e < details.size(); ++e) {
        const uint32_t h = topology.edge_half[e], twin = topology.twin[h];
        details[e] = of_faces[topology.face[h]];
        if (twin == kNone) continue;
        const EdgeDetail& other = of_faces[topology.face[twin]];
        for (size_t k = 0; k < other.size(); ++k) details[e][k] = std::max(details[e][k], other[k]);
    }
    return details;
}

std::vector<float> edge_texels(const Topology& topology, std::span<const vec2> uvs,
                               std::span<const uint32_t> source_of,
                               std::span<const DetailSource> sources) {
    std::vector<float> texels(topology.edge_count(), 0.0f);
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        const DetailSource& source = sources[source_of[topology.vertex[h]]];
        float& longest = texels[topology.edge[h]];
        if (source.map)
            longest = std::max(longest, texels_between(*source.map, uvs[h], uvs[topology.next(h)]));
    }
    return texels;
}

}  // namespace aglow
