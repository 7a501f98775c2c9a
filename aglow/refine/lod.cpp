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
constexpr int kBudgetSteps = 20;         // halvings of the range of tolerances
constexpr float kMostCoarseness = 1e8f;  // with it an edge that wished for 10^4 segments has one
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

/// Segments with which a displaced surface is `allowed` away, between powers of two as if the error
/// were a power of their number.
float segments_of(const EdgeDetail& errors, float allowed) {
    size_t k = 0;
    while (k < errors.size() && errors[k] > allowed) ++k;
    if (k == 0) return 0;
    if (k == errors.size()) return kMost;
    const float share =
        errors[k] > 0 ? std::log(errors[k - 1] / allowed) / std::log(errors[k - 1] / errors[k])
                      : 1.0f;
    return std::exp2(static_cast<float>(k - 1) + share);
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

/// What the error of an edge depends on.
struct LevelOfDetail::EdgeError {
    float curve = 0;   ///< of one segment, m
    float pixels = 0;  ///< that a metre of error counts as; 0: none does

    /// Segments with which the error is so many pixels; may be below 1.
    float wish(const EdgeDetail* detail, float tolerance) const {
        const float curved = std::sqrt(curve * pixels / tolerance);
        if (!detail || pixels == 0) return curved;
        return std::max(curved, segments_of(*detail, tolerance / pixels));
    }
};

namespace {

const EdgeDetail* detail_of(const EdgeFacts& facts, size_t edge) {
    return facts.details.empty() ? nullptr : &facts.details[edge];
}

}  // namespace

float LevelOfDetail::fit_budget(const Topology& topology, std::span<const EdgeError> errors,
                                const EdgeFacts& facts) const {
    std::vector<float> levels(errors.size());
    const auto triangles = [&](float coarseness) {
        parallel_for(levels.size(), kGrain, [&](size_t begin, size_t end) {
            for (size_t e = begin; e < end; ++e)
                levels[e] =
                    level_of(errors[e].wish(detail_of(facts, e), options_.tolerance * coarseness),
                             options_.levels);
        });
        return triangle_count(topology, levels, options_.levels);
    };
    if (triangles(1) <= options_.budget) return 1;
    const uint64_t last = triangles(last_coarseness_);
    const float kept = kBudgetKept * static_cast<float>(options_.budget);
    if (last <= options_.budget && static_cast<float>(last) >= kept) return last_coarseness_;
    float too_fine = 1, fits = kMostCoarseness;
    for (int step = 0; step < kBudgetSteps; ++step) {
        const float middle = std::sqrt(fits * too_fine);
        (triangles(middle) <= options_.budget ? fits : too_fine) = middle;
    }
    return fits;
}

LevelOfDetail::Choice LevelOfDetail::choose(const Topology& topology, const PatchControl& control,
                                            const Viewpoint& view, const EdgeFacts& facts) {
    std::vector<EdgeError> errors(topology.edge_count());
    parallel_for(errors.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e) {
            if (!facts.hidden.empty() && facts.hidden[e] != 0) continue;
            const uint32_t h = topology.edge_half[e];
            const uint32_t v = topology.vertex[h], w = topology.end(h);
            const vec3 a = control.positions[std::min(v, w)], b = control.positions[std::max(v, w)];
            errors[e].curve = curvature(control.edges[e], a, b) / 8;
            errors[e].pixels =
                scale_at(view, a, b) * importance(view, options_.silhouette, a, b,
                                                  control.directions[std::min(v, w)],
                                                  control.directions[std::max(v, w)]);
        }
    });
    last_coarseness_ = options_.budget > 0 ? fit_budget(topology, errors, facts) : 1;

    Choice choice;
    choice.tolerance = options_.tolerance * last_coarseness_;
    choice.levels.resize(errors.size());
    // Coarser levels wait; not where that would break the budget.
    std::vector<float> held(errors.size());
    const bool has_last = last_levels_.size() == held.size();
    parallel_for(errors.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e) {
            const float wish = errors[e].wish(detail_of(facts, e), choice.tolerance);
            choice.levels[e] = held[e] = level_of(wish, options_.levels);
            if (!has_last) continue;
            const float slow = level_of(wish * (1 + options_.hysteresis), options_.levels);
            held[e] = std::max(held[e], std::min(last_levels_[e], slow));
        }
    });
    choice.triangles = triangle_count(topology, held, options_.levels);
    if (options_.budget == 0 || choice.triangles <= options_.budget)
        choice.levels = std::move(held);
    else
        choice.triangles = triangle_count(topology, choice.levels, options_.levels);
    last_levels_ = choice.levels;
    return choice;
}

}  // namespace aglow
