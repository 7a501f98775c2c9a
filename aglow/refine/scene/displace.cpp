// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/displace.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aglow::refine {
namespace {

/// The mip level on which texels are as far apart as the vertices: the mean over all triangles of
/// the area that they have in the map.
float level_of(const RefinedSurface& surface, const HeightMap& map, std::span<const vec2> uvs) {
    double area = 0;
    for (const uvec3 t : surface.triangles) {
        const vec2 a = uvs[t.y] - uvs[t.x], b = uvs[t.z] - uvs[t.x];
        area += std::fabs(static_cast<double>(a.x * b.y - a.y * b.x));
    }
    const double texels =
        area / static_cast<double>(surface.triangles.size()) * map.levels.width * map.levels.height;
    return texels > 1 ? static_cast<float>(0.5 * std::log2(texels)) : 0.0f;
}

/// [refined vertex] Vertices on one place that share a normal have one number, the lowest of them.
std::vector<uint32_t> normal_groups(const RefinedSurface& surface, const RefinedShape& shape) {
    constexpr float kSameNormal = 0.9999f;
    std::vector<uint32_t> order(surface.vertex_count()), group(surface.vertex_count());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t v) { return surface.whole[v]; });
    for (size_t i = 0; i < order.size(); ++i) {
        const uint32_t v = order[i];
        group[v] = v;
        for (size_t k = i; k-- > 0 && surface.whole[order[k]] == surface.whole[v];)
            if (dot(shape.normals[order[k]], shape.normals[v]) > kSameNormal)
                group[v] = group[order[k]];
    }
    return group;
}

/// Normals of triangles at their corners, summed by group.
std::vector<vec3> group_normals(const RefinedSurface& surface, std::span<const vec3> positions,
                                std::span<const uint32_t> group) {
    std::vector<vec3> sums(positions.size(), vec3{0, 0, 0});
    for (const uvec3 t : surface.triangles) {
        const uint32_t v[] = {t.x, t.y, t.z};
        const vec3 normal = shared::unit_or(
            cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]), vec3{0, 0, 0});
        for (int i = 0; i < 3; ++i) {
            const vec3 a = positions[v[(i + 1) % 3]] - positions[v[i]];
            const vec3 b = positions[v[(i + 2) % 3]] - positions[v[i]];
            const float angle = std::atan2(length(cross(a, b)), dot(a, b));
            sums[group[v[i]]] = sums[group[v[i]]] + normal * angle;
        }
    }
    return sums;
}

}  // namespace

std::vector<float> map_heights(const RefinedSurface& surface,
                               const HeightDisplacement& displacement, std::span<const vec2> uvs) {
    const float level = level_of(surface, displacement.map, uvs);
    const uint32_t places = 1 + *std::ranges::max_element(surface.whole);
    std::vector<float> sums(places, 0.0f), counts(places, 0.0f);
    for (uint32_t v = 0; v < surface.vertex_count(); ++v) {
        sums[surface.whole[v]] += sample(displacement.map, uvs[v], level);
        ++counts[surface.whole[v]];
    }
    std::vector<float> heights;
    for (const uint32_t place : surface.whole)
        heights.push_back(displacement.scale * (sums[place] / counts[place]) + displacement.bias);
    return heights;
}

void displace(const RefinedSurface& surface, std::span<const float> heights, RefinedShape& shape) {
    const uint32_t places = 1 + *std::ranges::max_element(surface.whole);
    std::vector<vec3> directions(places, vec3{0, 0, 0});
    for (uint32_t v = 0; v < surface.vertex_count(); ++v)
        directions[surface.whole[v]] = directions[surface.whole[v]] + shape.normals[v];
    const std::vector<uint32_t> group = normal_groups(surface, shape);
    for (uint32_t v = 0; v < surface.vertex_count(); ++v)
        shape.positions[v] =
            shape.positions[v] +
            shared::unit_or(directions[surface.whole[v]], vec3{0, 0, 0}) * heights[v];
    const std::vector<vec3> normals = group_normals(surface, shape.positions, group);
    for (uint32_t v = 0; v < surface.vertex_count(); ++v)
        shape.normals[v] = shared::unit_or(normals[group[v]], shape.normals[v]);
}

}  // namespace aglow::refine
