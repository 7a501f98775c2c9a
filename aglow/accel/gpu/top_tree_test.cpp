// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/top_tree.h"

#include "aglow/core/math.h"
#include "aglow/core/random.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace aglow;
using accel::gpu::top_tree;
using shared::Bounds;
using shared::TopNode;

namespace {

bool contains(const Bounds& outer, const Bounds& inner) {
    return shared::min(outer.lower, inner.lower) == outer.lower &&
           shared::max(outer.upper, inner.upper) == outer.upper;
}

/// Walks the tree: every box is in exactly one leaf, inside all boxes above it; gives the depth.
uint32_t check(const std::vector<TopNode>& nodes, std::span<const Bounds> boxes) {
    REQUIRE(nodes.size() == (boxes.empty() ? 0 : 2 * boxes.size() - 1));
    std::vector<int> met(boxes.size());
    uint32_t deepest = 0;
    std::vector<std::pair<uint32_t, uint32_t>> waiting;  // node, depth
    if (!nodes.empty()) waiting.push_back({0, 0});
    while (!waiting.empty()) {
        const auto [index, depth] = waiting.back();
        waiting.pop_back();
        deepest = std::max(deepest, depth);
        const TopNode& node = nodes[index];
        if (node.count == 1) {
            REQUIRE(node.child < boxes.size());
            ++met[node.child];
            CHECK(contains(node.box, boxes[node.child]));
            continue;
        }
        REQUIRE(node.count == 0);
        for (const uint32_t child : {node.child, node.child + 1}) {
            REQUIRE(child < nodes.size());
            CHECK(contains(node.box, nodes[child].box));
            waiting.push_back({child, depth + 1});
        }
    }
    CHECK(std::all_of(met.begin(), met.end(), [](int times) { return times == 1; }));
    return deepest;
}

std::vector<Bounds> random_boxes(size_t count) {
    Pcg32 random(count);
    std::vector<Bounds> boxes;
    for (size_t i = 0; i < count; ++i) {
        const vec3 low{random.uniform(), random.uniform(), random.uniform()};
        boxes.push_back({low, low + vec3{random.uniform(), 0.01f, 0.0f}});
    }
    return boxes;
}

}  // namespace

TEST_CASE("a top-level tree holds every box once, inside all boxes above it") {
    for (const size_t count : {0, 1, 2, 3, 7, 64, 1000, 10000}) {
        CAPTURE(count);
        const auto boxes = random_boxes(count);
        CHECK(check(top_tree(boxes), boxes) <= shared::kTopDepth);
    }
}

TEST_CASE("boxes in one place still make a shallow tree") {
    const std::vector<Bounds> boxes(5000, Bounds{{1, 2, 3}, {2, 3, 4}});
    CHECK(check(top_tree(boxes), boxes) == 13);  // 2^13 = 8192
}

TEST_CASE("boxes that double in size and distance stay within the depth that shaders walk") {
    std::vector<Bounds> boxes;
    for (int i = -60; i < 60; ++i) {
        const float x = std::ldexp(1.0f, i);
        boxes.push_back({{x, 0, 0}, {1.5f * x, x, x}});
    }
    CHECK(check(top_tree(boxes), boxes) <= shared::kTopDepth);
}
