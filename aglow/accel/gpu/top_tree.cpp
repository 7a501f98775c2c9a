// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/top_tree.h"

#include "aglow/core/math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace aglow::accel::gpu {
namespace {

using shared::Bounds;
using shared::TopNode;

constexpr size_t kBinCount = 16;
constexpr Bounds kEmpty{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

Bounds united(const Bounds& a, const Bounds& b) {
    return {shared::min(a.lower, b.lower), shared::max(a.upper, b.upper)};
}

float half_area(const Bounds& box) {
    const vec3 size = box.upper - box.lower;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

float component(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Leaves below one node: a run of `order`.
struct Job {
    uint32_t node = 0;
    size_t first = 0, count = 0;
    uint32_t depth = 0;
};

class Builder {
public:
    explicit Builder(std::span<const Bounds> boxes) : boxes_(boxes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        nodes_.reserve(2 * boxes.size());
    }

    std::vector<TopNode> build() {
        std::vector<Job> jobs;
        if (!boxes_.empty()) {
            nodes_.push_back({});
            jobs.push_back({0, 0, boxes_.size(), 0});
        }
        while (!jobs.empty()) {
            const Job job = jobs.back();
            jobs.pop_back();
            TopNode& node = nodes_[job.node];
            node.box = bounds(job);
            if (job.count == 1) {
                node.child = order_[job.first];
                node.count = 1;
                continue;
            }
            const size_t left = split(job);
            const auto child = static_cast<uint32_t>(nodes_.size());
            node.child = child;
            node.count = 0;
            nodes_.resize(nodes_.size() + 2);
            jobs.push_back({child, job.first, left, job.depth + 1});
            jobs.push_back({child + 1, job.first + left, job.count - left, job.depth + 1});
        }
        return std::move(nodes_);
    }

private:
    std::span<uint32_t> run(const Job& job) {
        return std::span(order_).subspan(job.first, job.count);
    }
    vec3 center(uint32_t box) const { return boxes_[box].lower * 0.5f + boxes_[box].upper * 0.5f; }
    Bounds bounds(const Job& job) {
        Bounds box = kEmpty;
        for (const uint32_t i : run(job)) box = united(box, boxes_[i]);
        return box;
    }

    /// Orders the run so that its first part goes to the left child. Result: that part's length.
    size_t split(const Job& job) {
        Box centers;
        for (const uint32_t i : run(job)) centers.add(center(i));
        const auto levels_of_median = static_cast<uint32_t>(std::bit_width(job.count - 1));
        if (job.depth + levels_of_median < shared::kTopDepth)
            if (const size_t left = split_by_area(job, centers); left > 0) return left;
        return split_by_median(job, centers);
    }

    size_t split_by_median(const Job& job, const Box& centers) {
        const vec3 size = centers.size();
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        const auto middle = static_cast<std::ptrdiff_t>(job.count / 2);
        const auto range = run(job);
        std::nth_element(range.begin(), range.begin() + middle, range.end(),
                         [&](uint32_t a, uint32_t b) {
                             const float x = component(center(a), axis);
                             const float y = component(center(b), axis);
                             return x < y || (x == y && a < b);
                         });
        return job.count / 2;
    }

    /// 0 where all centers fall into one bin.
    size_t split_by_area(const Job& job, const Box& centers) {
        float best_cost = kInfinity;
        int best_axis = 0;
        size_t best_bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<Bounds, kBinCount> boxes;
            std::array<size_t, kBinCount> counts{};
            boxes.fill(kEmpty);
            for (const uint32_t i : run(job)) {
                const size_t b = bin(center(i), centers, axis);
                boxes[b] = united(boxes[b], boxes_[i]);
                ++counts[b];
            }
            std::array<float, kBinCount> right_cost{};
            Bounds right = kEmpty;
            for (size_t b = kBinCount - 1, n = 0; b > 0; --b) {
                right = united(right, boxes[b]);
                n += counts[b];
                right_cost[b] = n > 0 ? half_area(right) * static_cast<float>(n) : kInfinity;
            }
            Bounds left = kEmpty;
            for (size_t b = 1, n = 0; b < kBinCount; ++b) {
                left = united(left, boxes[b - 1]);
                n += counts[b - 1];
                if (n == 0) continue;
                const float cost = half_area(left) * static_cast<float>(n) + right_cost[b];
                if (cost >= best_cost) continue;
                best_cost = cost;
                best_axis = axis;
                best_bin = b;
            }
        }
        if (best_bin == 0) return 0;
        const auto range = run(job);
        const auto middle = std::stable_partition(range.begin(), range.end(), [&](uint32_t i) {
            return bin(center(i), centers, best_axis) < best_bin;
        });
        return static_cast<size_t>(middle - range.begin());
    }

    static size_t bin(vec3 center, const Box& centers, int axis) {
        const float low = component(centers.lo, axis);
        const float size = component(centers.hi, axis) - low;
        if (!(size > 0) || !(size < kInfinity)) return 0;
        const float place = (component(center, axis) - low) / size * static_cast<float>(kBinCount);
        return std::min(static_cast<size_t>(std::max(place, 0.0f)), kBinCount - 1);
    }

    std::span<const Bounds> boxes_;
    std::vector<uint32_t> order_;
    std::vector<TopNode> nodes_;
};

}  // namespace

std::vector<TopNode> top_tree(std::span<const Bounds> boxes) { return Builder(boxes).build(); }

}  // namespace aglow::accel::gpu
