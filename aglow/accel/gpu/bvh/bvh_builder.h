// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/shared/bvh_emit.h"
#include "aglow/vk/compact.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/radix_sort.h"
#include "aglow/vk/scan.h"

#include <memory>

namespace aglow::accel::gpu {

/// The kernels of building and refitting trees, and the memory they work in. In order: reserve(),
/// sort(), cluster(), collapse(), emit(). Every step ends with a barrier but emit() and refit().
class BvhBuilder {
public:
    static Result<std::shared_ptr<BvhBuilder>> create(const Gpu& gpu);

    const Gpu& gpu() const { return gpu_; }

    /// Scratch memory for a build. Finishes the stream where it has to grow.
    /// Errors  out_of_memory, device_lost.
    Status reserve(vk::Stream& stream, TriangleSpan triangles);
    /// Brings the triangles into the order of their Morton codes.
    void sort(vk::Stream& stream);
    /// A binary tree over them. `keep` is shared::kMergeKeep, or 1 for the tree of the codes.
    void cluster(vk::Stream& stream, uint32_t keep);
    /// Which of its nodes become wide ones, so that `metric` (shared::kCost...) is least; says how
    /// many they are. Finishes the stream.
    Result<shared::BvhCounters> collapse(vk::Stream& stream, uint32_t metric);

    /// Where a tree goes.
    struct Target {
        uint64_t header = 0, boxes = 0, parents = 0;
        uint32_t node_count = 0, triangle_count = 0;
    };
    void emit(vk::Stream& stream, const Target& target) const;
    void refit(vk::Stream& stream, shared::BvhRefitArgs args) const;

private:
    struct Kernels {
        vk::Kernel bounds, morton, leaves, merge, ready, cost, last_cost, flags, slots, index, emit,
            move, refit;
    };
    BvhBuilder(Gpu gpu, Kernels kernels, vk::RadixSort sort, vk::Compact compact, vk::Scan scan);
    void find_costs(vk::Stream& stream);
    void move(vk::Stream& stream, const shared::BvhRefitArgs& args) const;
    uint64_t offset(uint64_t address) const { return address - scratch_.address(); }

    Gpu gpu_;
    Kernels kernels_;
    vk::RadixSort sort_;
    vk::Compact compact_;
    vk::Scan scan_;
    vk::Buffer scratch_;  // all that args_ points to but the triangles
    shared::BvhBuildArgs args_ = {};
    uint64_t list_ = 0;      // binary nodes that become wide ones
    uint32_t reserved_ = 0;  // triangles that there is scratch memory for
};

}  // namespace aglow::accel::gpu
