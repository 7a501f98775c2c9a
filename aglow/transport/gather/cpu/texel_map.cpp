// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/texel_map.h"

namespace aglow::transport::cpu {

TexelMap::TexelMap(const Surfaces& surfaces, const Texels& texels)
    : width_(texels.width), height_(texels.height), nearest_(texels.element_at) {
    corners_.reserve(surfaces.triangles.size());
    for (const uvec3 t : surfaces.triangles) {
        const vec2 a = surfaces.lightmap_uvs[t.x];
        corners_.push_back({a, surfaces.lightmap_uvs[t.y] - a, surfaces.lightmap_uvs[t.z] - a});
    }
    const auto at = [&](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    };
    constexpr int kSteps[8][2] = {{-1, 0},  {1, 0},  {0, -1}, {0, 1},
                                  {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            if (texels.element_at[at(x, y)] != kNoElement) continue;
            for (const auto& step : kSteps) {
                const int nx = x + step[0], ny = y + step[1];
                if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
                const uint32_t element = texels.element_at[at(nx, ny)];
                if (element == kNoElement) continue;
                nearest_[at(x, y)] = element;
                break;
            }
        }
    if (texels.divided.empty()) return;
    for (uint32_t& element : nearest_)
        if (element != kNoElement && texels.divided[element]) element = kNoElement;
}

}  // namespace aglow::transport::cpu
