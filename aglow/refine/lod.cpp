// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/lod.h"

#include "aglow/core/parallel.h"
#include "aglow/refine/pattern.h"
#include "aglow/shared/pattern.h"

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

constexpr size_t kGrain = 4096;
constexpr int kBudgetSteps = 20;         // halvings of the range of scales
constexpr float kSmallestScale = 1e-4f;  // of wishes; 1 / kMostAdaptiveSegments and less make 1
constexpr float kBudgetKept = 0.85f;     // share of the budget that need not be fitted anew
constexpr float kOutlineSine = 0.35f;    // faces up to 20 degrees from edge-on are at the outline
constexpr float kMost = kMostAdaptiveSegments;

/// Bound on the second derivative of an edge's cubic, m.
float curvature(const shared::EdgePoints& points, vec3 a, vec3 b) {
    return 6 * std::max(length(a - points.first * 2 + points.second),
                        length(points.first - points.second * 2 + b));
}

/// Pixels per metre where the segment from a to b is nearest.
float scale_at(const Viewpoint& view, vec3 a, vec3 b) {
    if (!view.perspective) return view.pixels_per_metre;
    const vec3 chord = b - a;
    const float square = dot(chord, chord);
    const float t =
        square > 0 ? std::clamp(dot(view.position - a, chord) / square, 0.0f, 1.0f) : 0.0f;
    return view.pixels_per_metre / std::max(length(a + chord * t - view.position), view.nearest);
}

/// By how much the error of an edge counts, from the directions its ends face.
float importance(const Viewpoint& view, float silhouette, vec3 a, vec3 b, vec3 facing_a,
                 vec3 facing_b) {
    const auto towards = [&](vec3 p, vec3 facing) {
        const vec3 eye = view.perspective ? view.position - p : view.direction * -1.0f;
        const float distance = length(eye);
        return distance > 0 ? dot(eye, facing) / distance : 0.0f;
    };
    const float at_a = towards(a, facing_a), at_b = towards(b, facing_b);
    if (std::max(at_a, at_b) < -kOutlineSine) return 1 / silhouette;
    return std::min(at_a, at_b) > kOutlineSine ? 1 : silhouette;
}

/// Whole or continuous segments of an edge that wishes for so many, which may be below 1.
float level_of(float wish, Tessellation::Levels kind) {
    const float level = kind == Tessellation::Levels::discrete ? std::ceil(wish) : wish;
    return std::clamp(level, 1.0f, kMost);
}

std::vector<float> scaled_levels(std::span<const float> wishes, float scale,
                                 Tessellation::Levels kind) {
    std::vector<float> levels(wishes.size());
    std::transform(wishes.begin(), wishes.end(), levels.begin(),
                   [&](float wish) { return level_of(wish * scale, kind); });
    return levels;
}

}  // namespace

uint64_t triangle_count(const Topology& topology, std::span<const float> levels,
                        Tessellation::Levels kind) {
    const uint32_t continuous = kind == Tessellation::Levels::continuous ? 1 : 0;
    uint64_t count = 0;
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        uint64_t round = 0, most = 1;  // segments of the face's edges
        for (uint32_t h = topology.face_begin[f]; h < topology.face_begin[f + 1]; ++h) {
            const uint64_t own = shared::edge_segments(levels[topology.edge[h]], continuous);
            round += own;
            most = std::max(most, own);
        }
        // A disc of so many vertices inside and on its rim has 2 inside + rim - 2 triangles.
        const bool quad = topology.face_size(f) == 4;
        count += (quad ? 2 * (most - 1) * (most - 1) : (most - 1) * (most - 2)) + round - 2;
    }
    return count;
}

int uniform_level(std::span<const float> levels, int most) {
    const float finest = levels.empty() ? 1 : *std::max_element(levels.begin(), levels.end());
    int level = 0;
    while (level < most && static_cast<float>(uint64_t{1} << level) < finest) ++level;
    return level;
}

float LevelOfDetail::fit_budget(const Topology& topology, std::span<const float> wishes) const {
    const auto triangles = [&](float scale) {
        return triangle_count(topology, scaled_levels(wishes, scale, options_.levels),
                              options_.levels);
    };
    if (triangles(1) <= options_.budget) return 1;
    const uint64_t last = triangles(last_scale_);
    const float kept = kBudgetKept * static_cast<float>(options_.budget);
    if (last <= options_.budget && static_cast<float>(last) >= kept) return last_scale_;
    float fits = kSmallestScale, too_fine = 1;
    for (int step = 0; step < kBudgetSteps; ++step) {
        const float middle = std::sqrt(fits * too_fine);
        (triangles(middle) <= options_.budget ? fits : too_fine) = middle;
    }
    return fits;
}

LevelOfDetail::Choice LevelOfDetail::choose(const Topology& topology, const PatchControl& control,
                                            const Viewpoint& view) {
    std::vector<float> wishes(topology.edge_count());
    parallel_for(wishes.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e) {
            const uint32_t h = topology.edge_half[e];
            const uint32_t v = topology.vertex[h], w = topology.end(h);
            const vec3 a = control.positions[std::min(v, w)], b = control.positions[std::max(v, w)];
            const float pixels =
                curvature(control.edges[e], a, b) / 8 * scale_at(view, a, b) *
                importance(view, options_.silhouette, a, b, control.directions[std::min(v, w)],
                           control.directions[std::max(v, w)]);
            wishes[e] = std::sqrt(pixels / options_.tolerance);
        }
    });
    const float scale = options_.budget > 0 ? fit_budget(topology, wishes) : 1;
    last_scale_ = scale;

    Choice choice;
    choice.tolerance = options_.tolerance / (scale * scale);
    choice.levels = scaled_levels(wishes, scale, options_.levels);
    // Coarser levels wait; not where that would break the budget.
    std::vector<float> held = choice.levels;
    for (size_t e = 0; last_levels_.size() == held.size() && e < held.size(); ++e) {
        const float slow = level_of(wishes[e] * scale * (1 + options_.hysteresis), options_.levels);
        held[e] = std::max(held[e], std::min(last_levels_[e], slow));
    }
    choice.triangles = triangle_count(topology, held, options_.levels);
    if (options_.budget == 0 || choice.triangles <= options_.budget)
        choice.levels = std::move(held);
    else
        choice.triangles = triangle_count(topology, choice.levels, options_.levels);
    last_levels_ = choice.levels;
    return choice;
}

}  // namespace aglow
