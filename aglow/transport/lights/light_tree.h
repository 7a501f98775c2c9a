// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::transport {

/// A flat emitter as the tree sees it.
struct TreeEmitter {
    Box bounds;
    vec3 normal;             ///< unit
    float power = 0;         ///< luminous flux of one side, lm
    bool two_sided = false;  ///< emits from both sides
};

/// Binary hierarchy over emitters that draws one of them for a receiver, with probability roughly
/// in proportion to the light it can send there. An emitter that can send light has a positive
/// probability.
/// Cost    O(n log n) to build, O(log n) to draw.
/// Source  Conty Estevez & Kulla, "Importance Sampling of Many Lights with Adaptive Tree
///         Splitting", HPG 2018 (orientation cones, importance).
class LightTree {
public:
    LightTree() = default;
    explicit LightTree(std::span<const TreeEmitter> emitters);

    struct Choice {
        uint32_t emitter = 0;
        float probability = 0;  ///< 0: no emitter reaches the receiver
        float u = 0;            ///< what is left of the random number, uniform in [0, 1)
    };
    /// Draws an emitter for a receiver at `p` whose plane has normal `n`.
    Choice draw(vec3 p, vec3 n, float u) const;

    /// Probability with which draw() picks `emitter` for that receiver.
    float probability(uint32_t emitter, vec3 p, vec3 n) const;

    bool empty() const { return nodes_.empty(); }

private:
    struct Node {
        vec3 center;  ///< of the bounding sphere
        float radius2 = 0;
        vec3 axis = {0, 0, 1};  ///< of the cone that holds all normals
        float sin_half = 0;     ///< of that cone's half angle; 2 where it is beyond 90 degrees
        float power = 0;
        bool two_sided = false;
        uint32_t emitter = 0;  ///< leaf: which
        uint32_t right = 0;    ///< inner: second child (the first follows its parent); leaf: 0
        uint32_t parent = 0;
    };
    /// What building knows of a node and drawing does not need.
    struct Extent {
        uint32_t node;
        Box bounds;
        vec3 axis;
        float half_angle;
    };
    Extent build(std::span<uint32_t> order, std::span<const TreeEmitter> emitters);
    static float importance(const Node& node, vec3 p, vec3 n);

    std::vector<Node> nodes_;
    std::vector<uint32_t> leaf_of_;  // [emitter] its node
};

}  // namespace aglow::transport
