// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aglow::transport {
namespace {

float axis_of(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float safe_acos(float c) { return std::acos(std::clamp(c, -1.0f, 1.0f)); }

/// An angle in [0, pi] by its sine and cosine, so that bounds need no inverse functions.
struct Angle {
    float sine, cosine;
};

Angle angle_of_cosine(float c) {
    const float cosine = std::clamp(c, -1.0f, 1.0f);
    return {std::sqrt(1 - cosine * cosine), cosine};
}

Angle angle_of_sine(float s) { return {s, std::sqrt(std::max(0.0f, 1 - s * s))}; }

/// max(0, a - b)
Angle subtract(Angle a, Angle b) {
    if (a.cosine >= b.cosine) return {0, 1};
    return {a.sine * b.cosine - a.cosine * b.sine, a.cosine * b.cosine + a.sine * b.sine};
}

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
uint32_t LightTree::build(std::span<uint32_t> order, std::span<const TreeEmitter> emitters) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    if (order.size() == 1) {
        const TreeEmitter& e = emitters[order[0]];
        nodes_[index] = {e.bounds, e.normal, 0, 0, 1, e.power, e.two_sided, order[0], 0, 0};
        leaf_of_[order[0]] = index;
        return index;
    }
    Box centers;
    for (const uint32_t i : order) centers.add(emitters[i].bounds.center());
    const vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](uint32_t a, uint32_t b) {
                         const float ca = axis_of(emitters[a].bounds.center(), axis);
                         const float cb = axis_of(emitters[b].bounds.center(), axis);
                         return ca != cb ? ca < cb : a < b;
                     });
    const uint32_t left = build(order.first(half), emitters);
    const uint32_t right = build(order.subspan(half), emitters);

    const Node& a = nodes_[left];
    const Node& b = nodes_[right];
    const Cone cone = unite({a.axis, a.half_angle}, {b.axis, b.half_angle});
    Box bounds = a.bounds;
    bounds.add(b.bounds.lo);
    bounds.add(b.bounds.hi);
    nodes_[index] = {bounds,
                     cone.axis,
                     cone.half_angle,
                     std::sin(cone.half_angle),
                     std::cos(cone.half_angle),
                     a.power + b.power,
                     a.two_sided || b.two_sided,
                     0,
                     right,
                     0};
    nodes_[left].parent = nodes_[right].parent = index;
    return index;
}

// Power times upper bounds of both cosines over the squared distance. Inside the bounding sphere
// neither cosine is bounded, and the distance is taken as the sphere's radius.
float LightTree::importance(const Node& node, vec3 p, vec3 n) {
    const vec3 to_light = node.bounds.center() - p;
    const float distance2 = dot(to_light, to_light);
    const float radius2 = dot(node.bounds.size(), node.bounds.size()) / 4;
    if (distance2 <= radius2) return node.power / std::max(radius2, 1e-30f);

    const float distance = std::sqrt(distance2);
    const vec3 direction = to_light / distance;
    const Angle bounding = angle_of_sine(std::sqrt(radius2 / distance2));
    const float cos_receiver = subtract(angle_of_cosine(dot(n, direction)), bounding).cosine;
    if (cos_receiver <= 0) return 0;

    float cos_axis = -dot(node.axis, direction);
    if (node.two_sided) cos_axis = std::abs(cos_axis);
    const Angle beyond_cone = subtract(angle_of_cosine(cos_axis), {node.sin_half, node.cos_half});
    const float cos_emitter = subtract(beyond_cone, bounding).cosine;
    if (cos_emitter <= 0) return 0;
    return node.power * cos_receiver * cos_emitter / distance2;
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
