// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/topology/quads.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aglow::mesh {
namespace {

// Radians. Corners of a quad from 50 to 130 degrees, faces that meet at 40 at most: what Blender's
// "Tris to Quads" takes for good. A quad that an exporter wrote may have corners of 30 to 150.
constexpr float kMostSkew = 40 * kPi / 180;
constexpr float kMostSkewInOrder = 60 * kPi / 180;
constexpr float kMostFold = 40 * kPi / 180;
// Advantage of triangles in an exporter's order. Less than the 45 degrees by which the two halves
// of neighbouring squares are worse than the squares: other files list those one after the other.
constexpr float kOrderBonus = 20 * kPi / 180;

struct Candidate {
    float badness;
    uint32_t edge;
};

float angle(vec3 a, vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// Corners of the quad of which half-edge `h` is a diagonal: its start and end, the first two.
struct Quad {
    vec3 a, b, left, right;
};

Quad quad_at(const Topology& t, std::span<const vec3> positions, uint32_t h) {
    return {positions[t.vertex[h]], positions[t.end(h)], positions[t.vertex[t.previous(h)]],
            positions[t.vertex[t.previous(t.twin[h])]]};
}

/// Largest difference of a corner from a right angle, radians. Corners on the diagonal are sums of
/// two, so that those that turn inwards have more than 180 degrees.
float skew(const Quad& q) {
    const float at_a = angle(q.left - q.a, q.b - q.a) + angle(q.b - q.a, q.right - q.a);
    const float at_b = angle(q.left - q.b, q.a - q.b) + angle(q.a - q.b, q.right - q.b);
    float worst = 0;
    for (const float corner :
         {at_a, at_b, angle(q.a - q.left, q.b - q.left), angle(q.a - q.right, q.b - q.right)})
        worst = std::max(worst, std::abs(corner - kPi / 2));
    return worst;
}

float fold(const Quad& q) {
    return angle(cross(q.b - q.a, q.left - q.a), cross(q.right - q.a, q.b - q.a));
}

/// Whether the faces beside half-edge h follow each other as (a, b, c) and (a, c, d).
bool in_order(const Topology& t, uint32_t h) {
    const uint32_t twin = t.twin[h];
    const uint32_t first = std::min(h, twin), second = std::max(h, twin);
    return t.face[second] == t.face[first] + 1 && first == t.face_begin[t.face[first]] + 2 &&
           second == t.face_begin[t.face[second]];
}

std::optional<Candidate> candidate(const Topology& t, std::span<const vec3> positions,
                                   uint32_t edge) {
    const uint32_t h = t.edge_half[edge];
    const Quad quad = quad_at(t, positions, h);
    const float skewed = skew(quad), folded = fold(quad);
    const bool ordered = in_order(t, h);
    if (!(skewed <= (ordered ? kMostSkewInOrder : kMostSkew) && folded <= kMostFold))
        return std::nullopt;
    return Candidate{skewed + folded - (ordered ? kOrderBonus : 0), edge};
}

}  // namespace

std::vector<uint32_t> pair_triangles(const Topology& triangles, std::span<const vec3> positions,
                                     const std::vector<bool>& joinable) {
    std::vector<Candidate> candidates;
    for (uint32_t e = 0; e < triangles.edge_count(); ++e) {
        if (!joinable[e] || triangles.twin[triangles.edge_half[e]] == kNone) continue;
        if (const auto found = candidate(triangles, positions, e)) candidates.push_back(*found);
    }
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
        return a.badness != b.badness ? a.badness < b.badness : a.edge < b.edge;
    });
    std::vector<uint32_t> diagonal(triangles.face_count(), kNone);
    for (const Candidate& c : candidates) {
        const uint32_t h = triangles.edge_half[c.edge], twin = triangles.twin[h];
        uint32_t &a = diagonal[triangles.face[h]], &b = diagonal[triangles.face[twin]];
        if (a != kNone || b != kNone) continue;
        a = h;
        b = twin;
    }
    return diagonal;
}

}  // namespace aglow::mesh
