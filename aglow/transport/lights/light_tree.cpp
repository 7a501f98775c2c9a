// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aglow::transport {
namespace {

float axis_of(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float safe_acos(float c) { return std::acos(std::clamp(c, -1.0f, 1.0f)); }

struct Cone {
    vec3 axis;
    float half_angle;
};

/// Smallest cone about the bisector that holds both.
Cone unite(const Cone& a, const Cone& b) {
    const float between = safe_acos(dot(a.axis, b.axis));
    if (between + b.half_angle <= a.half_angle) return a;
    if (between + a.half_angle <= b.half_angle) return b;
    const float half_angle = (a.half_angle + between + b.half_angle) / 2;
    const vec3 turn = cross(a.axis, b.axis);
    if (half_angle >= kPi || length(turn) < 1e-6f) return {a.axis, kPi};
    const float rotate = half_angle - a.half_angle;
    const vec3 side = normalize(cross(turn, a.axis));
    return {normalize(a.axis * std::cos(rotate) + side * std::sin(rotate)), half_angle};
}

}  // namespace

LightTree::LightTree(std::span<const TreeEmitter> emitters) {
    if (emitters.empty()) return;
    nodes_.reserve(2 * emitters.size());
    leaf_of_.resize(emitters.size());
    std::vector<uint32_t> order(emitters.size());
    std::iota(order.begin(), order.end(), 0u);
    build(order, emitters);
}

// Median splits along the longest axis of the centres: depth stays logarithmic whatever the input.
LightTree::Extent LightTree::build(std::span<uint32_t> order,
                                   std::span<const TreeEmitter> emitters) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    if (order.size() == 1) {
        const TreeEmitter& e = emitters[order[0]];
        const vec3 size = e.bounds.size();
        nodes_[index] = {e.bounds.center(),
                         dot(size, size) / 4,
                         e.normal,
                         0,
                         e.power,
                         e.two_sided,
                         order[0],
                         0,
                         0};
        leaf_of_[order[0]] = index;
        return {index, e.bounds, e.normal, 0};
    }
    Box centers;
    for (const uint32_t i : order) centers.add(emitters[i].bounds.center());
    const vec3 spread = centers.size();
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0
                     : spread.y >= spread.z                       ? 1
                                                                  : 2;
    const size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](uint32_t a, uint32_t b) {
                         const float ca = axis_of(emitters[a].bounds.center(), axis);
                         const float cb = axis_of(emitters[b].bounds.center(), axis);
                         return ca != cb ? ca < cb : a < b;
                     });
    const Extent left = build(order.first(half), emitters);
    const Extent right = build(order.subspan(half), emitters);

    const Cone cone = unite({left.axis, left.half_angle}, {right.axis, right.half_angle});
    Box bounds = left.bounds;
    bounds.add(right.bounds.lo);
    bounds.add(right.bounds.hi);
    Node& a = nodes_[left.node];
    Node& b = nodes_[right.node];
    a.parent = b.parent = index;
    const vec3 size = bounds.size();
    nodes_[index] = {bounds.center(),
                     dot(size, size) / 4,
                     cone.axis,
                     cone.half_angle < kPi / 2 ? std::sin(cone.half_angle) : 2.0f,
                     a.power + b.power,
                     a.two_sided || b.two_sided,
                     0,
                     right.node,
                     0};
    return {index, bounds, cone.axis, cone.half_angle};
}

// Power over the squared distance, times a bound of each cosine over the bounding sphere and the
// cone of normals. Where the sphere is seen under the angle beta, cos(theta - beta) is positive
// exactly where cos(theta) + sin(beta) is; with the cone's angle alpha, sin(alpha + beta) <=
// sin(alpha) + sin(beta). These sums serve as the bounds: no light that can arrive gets
// probability 0, and no angle has to be computed. Inside the sphere nothing is bounded, and the
// distance is taken as its radius.
float LightTree::importance(const Node& node, vec3 p, vec3 n) {
    const vec3 to_light = node.center - p;
    const float distance2 = dot(to_light, to_light);
    if (distance2 <= node.radius2) return node.power / std::max(node.radius2, 1e-30f);

    const float inverse2 = 1 / distance2;
    const float inverse = std::sqrt(inverse2);
    const float sin_bounding = std::sqrt(node.radius2 * inverse2);
    const float receiver = dot(n, to_light) * inverse + sin_bounding;
    const float cos_axis = -dot(node.axis, to_light) * inverse;
    const float emitter =
        (node.two_sided ? std::abs(cos_axis) : cos_axis) + node.sin_half + sin_bounding;
    if (!(receiver > 0) || !(emitter > 0)) return 0;
    return node.power * inverse2 * std::min(1.0f, receiver) * std::min(1.0f, emitter);
}

LightTree::Choice LightTree::draw(vec3 p, vec3 n, float u) const {
    if (nodes_.empty()) return {};
    uint32_t index = 0;
    float probability = 1;
    if (nodes_[0].right == 0 && importance(nodes_[0], p, n) <= 0) return {};
    while (nodes_[index].right != 0) {
        const uint32_t left = index + 1, right = nodes_[index].right;
        const float importance_left = importance(nodes_[left], p, n);
        const float importance_right = importance(nodes_[right], p, n);
        const float sum = importance_left + importance_right;
        if (!(sum > 0)) return {};
        const float share = importance_left / sum;
        if (u < share) {
            u /= share;
            probability *= share;
            index = left;
        } else {
            u = (u - share) / (1 - share);
            probability *= 1 - share;
            index = right;
        }
        u = std::min(u, 0x1.fffffep-1f);
    }
    return {nodes_[index].emitter, probability, u};
}

float LightTree::probability(uint32_t emitter, vec3 p, vec3 n) const {
    uint32_t index = leaf_of_[emitter];
    if (index == 0) return importance(nodes_[0], p, n) > 0 ? 1.0f : 0.0f;
    float result = 1;
    for (; index != 0; index = nodes_[index].parent) {
        const uint32_t parent = nodes_[index].parent;
        const float left = importance(nodes_[parent + 1], p, n);
        const float right = importance(nodes_[nodes_[parent].right], p, n);
        const float own = index == parent + 1 ? left : right;
        if (!(own > 0)) return 0;
        result *= own / (left + right);
    }
    return result;
}

}  // namespace aglow::transport
