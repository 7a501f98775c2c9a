// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair/chart_texels.h"

#include <algorithm>
#include <cmath>

namespace aglow::bake::fair {
namespace {

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

struct Nearest {
    vec2 barycentrics = {0, 0};
    float square = 0;  // of the distance, texels
};

/// On the edge from corner i to the next.
Nearest nearest_on_edge(const ChartTriangle& t, size_t i, vec2 p) {
    const vec2 a = t[i], along = t[(i + 1) % 3] - a, to = p - a;
    const float length_square = dot(along, along);
    const float s = length_square > 0 ? std::clamp(dot(to, along) / length_square, 0.0f, 1.0f) : 0;
    const vec2 off = to - along * s;
    const std::array<vec2, 3> places = {vec2{s, 0}, vec2{1 - s, s}, vec2{0, 1 - s}};
    return {places[i], dot(off, off)};
}

Nearest nearest_place(const ChartTriangle& t, vec2 p) {
    const vec2 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
    const float area = cross2(ab, ac);
    if (area != 0) {
        const vec2 at = {cross2(ap, ac) / area, cross2(ab, ap) / area};
        if (at.x >= 0 && at.y >= 0 && at.x + at.y <= 1) return {at, 0};
    }
    Nearest best = nearest_on_edge(t, 0, p);
    for (size_t i = 1; i < 3; ++i)
        if (const Nearest other = nearest_on_edge(t, i, p); other.square < best.square)
            best = other;
    return best;
}

}  // namespace

std::vector<ChartTexel> chart_texels(std::span<const ChartTriangle> triangles, int width,
                                     int height, float gutter) {
    const auto columns = static_cast<size_t>(width);
    std::vector<ChartTexel> texels(columns * static_cast<size_t>(height));
    std::vector<float> squares(texels.size(), gutter * gutter);
    for (size_t i = 0; i < triangles.size(); ++i) {
        const ChartTriangle& t = triangles[i];
        const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
        const auto bound = [](float v, int size) {
            return std::clamp(static_cast<int>(std::floor(v)), 0, size - 1);
        };
        const int last_x = bound(right + gutter, width), last_y = bound(bottom + gutter, height);
        for (int y = bound(top - gutter, height); y <= last_y; ++y)
            for (int x = bound(left - gutter, width); x <= last_x; ++x) {
                const size_t at = static_cast<size_t>(y) * columns + static_cast<size_t>(x);
                if (texels[at].inside) continue;
                const Nearest place =
                    nearest_place(t, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
                if (place.square > 0 && place.square >= squares[at]) continue;
                squares[at] = place.square;
                texels[at] = {static_cast<uint32_t>(i), place.barycentrics, place.square == 0};
            }
    }
    return texels;
}

}  // namespace aglow::bake::fair
