// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/obj/polygon.h"

#include "aglow/core/assert.h"

#include <numeric>

namespace aglow::obj {
namespace {

/// Twice the polygon's area times its normal, however bent it is.
/// Source  Newell's method; Sutherland, Sproull & Schumacker, Computing Surveys, 1974.
vec3 newell_normal(std::span<const vec3> corners) {
    vec3 sum{};
    for (size_t i = 0; i < corners.size(); ++i) {
        // Relative to one corner, so that far from the origin nothing is lost.
        const vec3 a = corners[i] - corners[0];
        const vec3 b = corners[(i + 1) % corners.size()] - corners[0];
        sum += cross(a, b);
    }
    return sum;
}

/// The polygon seen along its normal: counter-clockwise.
std::vector<vec2> flattened(std::span<const vec3> corners) {
    const vec3 normal = newell_normal(corners);
    const float size = length(normal);
    const Frame frame(size > 0 && std::isfinite(size) ? normal / size : vec3{0, 0, 1});
    std::vector<vec2> flat;
    flat.reserve(corners.size());
    for (const vec3 corner : corners) {
        const vec3 p = corner - corners[0];
        flat.push_back({dot(p, frame.tangent), dot(p, frame.bitangent)});
    }
    return flat;
}

/// Twice the signed area of a b c.
float turn(vec2 a, vec2 b, vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

class EarClipper {
public:
    explicit EarClipper(std::vector<vec2> points) : points_(std::move(points)) {
        left_.resize(points_.size());
        std::iota(left_.begin(), left_.end(), 0u);
    }

    std::vector<uvec3> run() {
        std::vector<uvec3> triangles;
        while (left_.size() > 3) {
            const size_t ear = find_ear();
            triangles.push_back({at(ear + left_.size() - 1), at(ear), at(ear + 1)});
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        triangles.push_back({left_[0], left_[1], left_[2]});
        return triangles;
    }

private:
    uint32_t at(size_t i) const { return left_[i % left_.size()]; }

    /// The best-shaped ear of a quadrilateral, else the first; a polygon that crosses itself may
    /// have none, then its widest corner is cut.
    size_t find_ear() const {
        size_t best = 0;
        float best_turn = -kInfinity;
        for (size_t i = 0; i < left_.size(); ++i) {
            if (is_ear(i) && left_.size() > 4) return i;
            const float corner = (is_ear(i) ? 1e30f : 0) + smallest_turn(i);
            if (corner > best_turn) {
                best = i;
                best_turn = corner;
            }
        }
        return best;
    }

    /// Of the ear and, in a quadrilateral, of what it leaves.
    float smallest_turn(size_t i) const {
        const uint32_t a = at(i + left_.size() - 1), b = at(i), c = at(i + 1), d = at(i + 2);
        const float ear = turn(points_[a], points_[b], points_[c]);
        return left_.size() == 4 ? std::min(ear, turn(points_[a], points_[c], points_[d])) : ear;
    }

    bool is_ear(size_t i) const {
        const uint32_t a = at(i + left_.size() - 1), b = at(i), c = at(i + 1);
        const vec2 p = points_[a], q = points_[b], r = points_[c];
        if (turn(p, q, r) <= 0) return false;
        for (const uint32_t other : left_) {
            const vec2 o = points_[other];
            if (other == a || other == b || other == c || o == p || o == q || o == r) continue;
            if (turn(p, q, o) >= 0 && turn(q, r, o) >= 0 && turn(r, p, o) >= 0) return false;
        }
        return true;
    }

    std::vector<vec2> points_;
    std::vector<uint32_t> left_;
};

}  // namespace

std::vector<uvec3> triangulate(std::span<const vec3> corners) {
    AG_ASSERT(corners.size() >= 3, "a polygon has at least three corners");
    if (corners.size() == 3) return {{0, 1, 2}};
    return EarClipper(flattened(corners)).run();
}

}  // namespace aglow::obj
