// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/face_bins.h"

#include "aglow/refine/pattern.h"
#include "aglow/shared/pattern.h"

#include <algorithm>

namespace aglow::render::gpu {

FaceSizes face_sizes(const Topology& topology, std::span<const uint32_t> patch_of,
                     std::span<const float> levels) {
    FaceSizes sizes;
    sizes.segments.assign(patch_of.size(), 0);
    sizes.triangles.assign(patch_of.size(), 0);
    for (size_t face = 0; face < patch_of.size(); ++face) {
        if (patch_of[face] == kNone) continue;
        const uint32_t first = topology.face_begin[patch_of[face]];
        uint32_t most = 1, round = 0;
        for (uint32_t h = first; h < first + 3; ++h) {
            const uint32_t own = shared::edge_segments(levels[topology.edge[h]], 0);
            most = std::max(most, own);
            round += own;
        }
        sizes.segments[face] = static_cast<uint8_t>(most);
        sizes.triangles[face] = (most - 1) * (most - 2) + round - 2;
    }
    return sizes;
}

FaceBins face_bins(const FaceSizes& sizes,
                   std::span<const std::vector<FaceRange>, kSolidLayers> layers) {
    FaceBins result;
    for (size_t layer = 0; layer < kSolidLayers; ++layer) {
        std::array<uint32_t, kMostAdaptiveSegments + 1> counts{};
        for (const FaceRange& run : layers[layer])
            for (uint32_t face = run.first; face < run.first + run.count; ++face) {
                ++counts[sizes.segments[face]];
                result.triangles[layer] += sizes.triangles[face];
            }
        std::array<uint32_t, kMostAdaptiveSegments + 1> next{};
        auto place = static_cast<uint32_t>(result.faces.size());
        for (uint32_t segments = 1; segments < counts.size(); ++segments) {
            next[segments] = place;
            if (counts[segments] == 0) continue;
            result.draws[layer].push_back(pattern_draw({place, counts[segments]}, segments));
            place += counts[segments];
        }
        result.faces.resize(place);
        for (const FaceRange& run : layers[layer])
            for (uint32_t face = run.first; face < run.first + run.count; ++face)
                if (sizes.segments[face] > 0) result.faces[next[sizes.segments[face]]++] = face;
    }
    return result;
}

}  // namespace aglow::render::gpu
