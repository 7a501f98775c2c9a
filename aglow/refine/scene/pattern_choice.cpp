// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/pattern_choice.h"

#include "aglow/refine/lod.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aglow::refine {
namespace {

// Beyond that triangles get too long.
constexpr float kSparsest = 0.7f, kDensest = 1.4f;
// Of the mean: where nothing bends, vertices are still wanted for what else varies there.
constexpr float kLeastCurvature = 0.1f;

/// Curvature of a cubic Bezier curve at its start, by its first three control points.
float curvature(vec3 a, vec3 b, vec3 c) {
    const vec3 tangent = (b - a) * 3, bend = (a - b * 2 + c) * 6;
    const float speed = length(tangent);
    return speed > 0 ? length(cross(tangent, bend)) / (speed * speed * speed) : 0;
}

float mean(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
}

/// [vertex] The mean of the edges there.
std::vector<float> vertex_curvature(const Topology& topology, const PatchControl& control) {
    std::vector<float> sums(topology.vertex_count(), 0.0f), counts(topology.vertex_count(), 0.0f);
    const auto add = [&](uint32_t v, float value) {
        sums[v] += value;
        ++counts[v];
    };
    for (uint32_t e = 0; e < topology.edge_count(); ++e) {
        const uint32_t h = topology.edge_half[e];
        const uint32_t low = std::min(topology.vertex[h], topology.end(h));
        const uint32_t high = std::max(topology.vertex[h], topology.end(h));
        const vec3 a = control.positions[low], d = control.positions[high];
        const shared::EdgePoints& p = control.edges[e];
        add(low, curvature(a, p.first, p.second));
        add(high, curvature(d, p.second, p.first));
    }
    for (size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(counts[v], 1.0f);
    return sums;
}

}  // namespace

std::vector<float> vertex_density(const Topology& topology, const PatchControl& control,
                                  const std::optional<vec3>& eye) {
    std::vector<float> wanted = vertex_curvature(topology, control);
    const float usual = mean(wanted);
    for (size_t v = 0; v < wanted.size(); ++v) {
        wanted[v] = usual > 0 ? std::max(wanted[v], kLeastCurvature * usual) : 1;
        if (eye) wanted[v] /= std::max(length(control.positions[v] - *eye), 1e-6f);
    }
    const float middle = mean(wanted);
    // Along an edge vertices are as dense as the square of these.
    for (float& w : wanted) w = std::clamp(std::sqrt(std::sqrt(w / middle)), kSparsest, kDensest);
    return wanted;
}

std::vector<float> edge_levels(const Topology& topology, const PatchControl& control,
                               float tolerance, float most) {
    // Seen from infinity a metre is a pixel.
    const Viewpoint view{.perspective = false, .pixels_per_metre = 1};
    LevelOfDetail detail({.tolerance = tolerance, .silhouette = 1});
    std::vector<float> levels = detail.choose(topology, control, view).levels;
    for (float& level : levels) level = std::min(level, most);
    return levels;
}

}  // namespace aglow::refine
