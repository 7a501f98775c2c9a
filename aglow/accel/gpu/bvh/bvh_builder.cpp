// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/bvh/bvh_builder.h"

#include "aglow/accel/gpu/bvh/bvh_bounds.comp.h"
#include "aglow/accel/gpu/bvh/bvh_cost.comp.h"
#include "aglow/accel/gpu/bvh/bvh_emit.comp.h"
#include "aglow/accel/gpu/bvh/bvh_flags.comp.h"
#include "aglow/accel/gpu/bvh/bvh_index.comp.h"
#include "aglow/accel/gpu/bvh/bvh_leaves.comp.h"
#include "aglow/accel/gpu/bvh/bvh_merge.comp.h"
#include "aglow/accel/gpu/bvh/bvh_morton.comp.h"
#include "aglow/accel/gpu/bvh/bvh_move.comp.h"
#include "aglow/accel/gpu/bvh/bvh_ready.comp.h"
#include "aglow/accel/gpu/bvh/bvh_refit.comp.h"
#include "aglow/accel/gpu/bvh/bvh_slots.comp.h"
#include "aglow/vk/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace aglow::accel::gpu {

using shared::BvhCounters;
using vk::group_count;
using vk::Kernel;
using vk::Stream;

namespace {

/// Hands out parts of a buffer whose size is not known before the last one.
class Parts {
public:
    explicit Parts(uint64_t base) : next_(base), base_(base) {}
    uint64_t take(uint64_t bytes) {
        return std::exchange(next_, next_ + (bytes + 255) / 256 * 256);
    }
    uint64_t bytes() const { return next_ - base_; }

private:
    uint64_t next_, base_;
};

/// Lays the build's arrays out from `base`; says how many bytes they take.
uint64_t place(shared::BvhBuildArgs& args, uint64_t& list, uint64_t base) {
    const uint64_t n = args.triangle_count;
    Parts parts(base);
    args.counters = parts.take(sizeof(BvhCounters));
    args.keys = parts.take(4 * n);
    args.order = parts.take(4 * n);
    args.nodes = parts.take(2 * n * sizeof(shared::BinaryNode));
    args.parents = parts.take(2 * n * 4);
    args.arrivals = parts.take(4 * n);
    // Stretches of at least two leaves, for the tree of the codes.
    args.stretches = parts.take((n / 2 + 1) * sizeof(shared::Stretch));
    args.clusters = parts.take(n * sizeof(shared::Cluster));
    args.costs = parts.take(n * sizeof(shared::CollapseCost));
    args.links = parts.take(n * sizeof(shared::CollapseChoice));
    args.flags = parts.take(4 * n);
    list = parts.take(4 * n);
    return parts.bytes();
}

uint64_t groups_of(uint64_t count) { return group_count(count, shared::kBvhGroupSize); }

/// Invocations in a group of the kernels that climb from node to node, with a memory barrier at
/// each step. To lavapipe (Mesa 22.3) that is a barrier of the whole group, which invocations that
/// have stopped never reach, unless the group is a single subgroup.
uint32_t climbing_group_size(const Gpu& gpu) {
    const bool software = gpu->info().kind == GpuKind::software;
    return software ? gpu->subgroup_size() : shared::kBvhGroupSize;
}

}  // namespace

BvhBuilder::BvhBuilder(Gpu gpu, Kernels kernels, vk::RadixSort sort, vk::Compact compact,
                       vk::Scan scan)
    : gpu_(std::move(gpu)),
      kernels_(std::move(kernels)),
      sort_(std::move(sort)),
      compact_(std::move(compact)),
      scan_(std::move(scan)) {}

Result<std::shared_ptr<BvhBuilder>> BvhBuilder::create(const Gpu& gpu) {
    const std::array climbing = {climbing_group_size(gpu)};
    const std::array merging = {gpu->subgroup_size()};
    AG_TRY(auto bounds, Kernel::create(gpu, "bvh: bounds", shaders::bvh_bounds_comp));
    AG_TRY(auto morton, Kernel::create(gpu, "bvh: codes", shaders::bvh_morton_comp));
    AG_TRY(auto leaves, Kernel::create(gpu, "bvh: leaves", shaders::bvh_leaves_comp));
    AG_TRY(auto merge, Kernel::create(gpu, "bvh: merge", shaders::bvh_merge_comp, merging));
    AG_TRY(auto ready, Kernel::create(gpu, "bvh: ready", shaders::bvh_ready_comp));
    AG_TRY(auto cost, Kernel::create(gpu, "bvh: cost", shaders::bvh_cost_comp,
                                     std::array{shared::kBvhGroupSize, 0u}));
    AG_TRY(auto last_cost, Kernel::create(gpu, "bvh: last costs", shaders::bvh_cost_comp,
                                          std::array{climbing_group_size(gpu), 1u}));
    AG_TRY(auto flags, Kernel::create(gpu, "bvh: flags", shaders::bvh_flags_comp));
    AG_TRY(auto slots, Kernel::create(gpu, "bvh: slots", shaders::bvh_slots_comp));
    AG_TRY(auto index, Kernel::create(gpu, "bvh: index", shaders::bvh_index_comp));
    AG_TRY(auto emit, Kernel::create(gpu, "bvh: emit", shaders::bvh_emit_comp));
    AG_TRY(auto move, Kernel::create(gpu, "bvh: move", shaders::bvh_move_comp));
    AG_TRY(auto refit, Kernel::create(gpu, "bvh: refit", shaders::bvh_refit_comp, climbing));
    AG_TRY(auto sort, vk::RadixSort::create(gpu));
    AG_TRY(auto compact, vk::Compact::create(gpu));
    AG_TRY(auto scan, vk::Scan::create(gpu));
    Kernels kernels{std::move(bounds), std::move(morton), std::move(leaves),    std::move(merge),
                    std::move(ready),  std::move(cost),   std::move(last_cost), std::move(flags),
                    std::move(slots),  std::move(index),  std::move(emit),      std::move(move),
                    std::move(refit)};
    return std::shared_ptr<BvhBuilder>(new BvhBuilder(gpu, std::move(kernels), std::move(sort),
                                                      std::move(compact), std::move(scan)));
}

Status BvhBuilder::reserve(Stream& stream, TriangleSpan triangles) {
    args_ = {};
    args_.triangle_count = triangles.count;
    args_.triangles = triangles.address;
    const uint64_t bytes = place(args_, list_, 0);
    if (triangles.count > reserved_) {
        reserved_ = 0;
        AG_CHECK(stream.finish());
        const Status grown = gpu_->grow(scratch_, bytes, "scratch memory of a BVH");
        if (!grown && grown.error().code == Errc::out_of_memory)
            return fail(Errc::out_of_memory,
                        fmt::format("building a BVH over {} triangles takes {} bytes: {}",
                                    triangles.count, bytes, grown.error().message));
        AG_CHECK(grown);
        AG_CHECK(sort_.reserve(triangles.count));
        AG_CHECK(compact_.reserve(triangles.count));
        AG_CHECK(scan_.reserve(triangles.count));
        reserved_ = triangles.count;
    }
    place(args_, list_, scratch_.address());
    return {};
}

void BvhBuilder::sort(Stream& stream) {
    {
        const Stream::Scope scope(stream, "bounds");
        BvhCounters counters = {};
        counters.lower = {0xffffffffu, 0xffffffffu, 0xffffffffu};
        stream.upload(std::span<const BvhCounters>(&counters, 1), scratch_, offset(args_.counters));
        stream.barrier();
        stream.run(kernels_.bounds, args_, groups_of(group_count(args_.triangle_count, 16)));
        stream.barrier();
    }
    const Stream::Scope scope(stream, "sort");
    stream.run(kernels_.morton, args_, groups_of(args_.triangle_count));
    stream.barrier();
    const vk::Sorted sorted = sort_.record(stream, args_.keys, args_.order, args_.triangle_count,
                                           shared::kMortonBits + 1);
    args_.keys = sorted.keys;
    args_.order = sorted.values;
    stream.barrier();
}

void BvhBuilder::cluster(Stream& stream, uint32_t keep) {
    const Stream::Scope scope(stream, "cluster");
    const uint64_t n = args_.triangle_count;
    args_.merge_keep = keep;
    stream.fill(scratch_, shared::kNoNode, offset(args_.arrivals), 4 * n);
    stream.fill(scratch_, 0, offset(args_.counters) + offsetof(BvhCounters, stretch_count), 4);
    stream.barrier();
    stream.run(kernels_.leaves, args_, groups_of(n));
    stream.barrier();
    stream.run(kernels_.merge, args_, n / (keep + 1) + 1);
    stream.barrier();
}

void BvhBuilder::find_costs(Stream& stream) {
    const uint64_t n = args_.triangle_count;
    stream.fill(scratch_, 0, offset(args_.counters) + offsetof(BvhCounters, ready),
                sizeof(BvhCounters::ready));
    stream.barrier();
    stream.run(kernels_.ready, args_, groups_of(n));
    stream.barrier();
    for (args_.wave = 0; args_.wave <= shared::kCostWaves; ++args_.wave) {
        // A node of the k-th wave has k + 2 leaves at least. How many there are only the device
        // knows, so an invocation takes several and there are a quarter of what could be needed.
        const bool is_last = args_.wave == shared::kCostWaves;
        const uint32_t size = is_last ? climbing_group_size(gpu_) : shared::kBvhGroupSize;
        const uint64_t groups = n / (args_.wave + 2) / 4 / size + 1;
        args_.stride = static_cast<uint32_t>(groups * size);
        stream.run(is_last ? kernels_.last_cost : kernels_.cost, args_, groups);
        stream.barrier();
    }
}

Result<BvhCounters> BvhBuilder::collapse(Stream& stream, uint32_t metric) {
    const uint64_t n = args_.triangle_count;
    args_.cost_metric = metric;
    {
        const Stream::Scope scope(stream, "collapse");
        find_costs(stream);
        stream.run(kernels_.flags, args_, groups_of(n));
        stream.barrier();
        compact_.record(stream, args_.flags, n, list_,
                        args_.counters + offsetof(BvhCounters, node_count));
    }
    BvhCounters counters;
    AG_CHECK(stream.download_bytes(scratch_, offset(args_.counters),
                                   std::as_writable_bytes(std::span(&counters, 1))));
    if (counters.usable_count == 1) {
        // A single leaf is no inner node of the binary tree, but needs a node to be in.
        stream.upload(std::span<const uint32_t>(&counters.root, 1), scratch_, offset(list_));
        stream.barrier();
        counters.node_count = 1;
        counters.depth = 1;
    }
    return counters;
}

void BvhBuilder::emit(Stream& stream, const Target& target) const {
    const Stream::Scope scope(stream, "emit");
    // What the steps before it needed and no later one does makes room for this one's arrays.
    const shared::BvhEmitArgs args{.first_group = 0,
                                   .triangle_count = args_.triangle_count,
                                   .node_count = target.node_count,
                                   .pad = 0,
                                   .triangles = args_.triangles,
                                   .counters = args_.counters,
                                   .binary = args_.nodes,
                                   .links = args_.links,
                                   .list = list_,
                                   .slots = args_.costs,
                                   .children = args_.clusters,
                                   .leaf_sizes = args_.clusters + 4ull * args_.triangle_count,
                                   .indices = args_.flags,
                                   .header = target.header,
                                   .boxes = target.boxes,
                                   .parents = target.parents};
    const uint64_t groups = groups_of(target.node_count);
    stream.run(kernels_.slots, args, groups);
    stream.barrier();
    scan_.record(stream, args.children, args.children, target.node_count);
    stream.barrier();
    scan_.record(stream, args.leaf_sizes, args.leaf_sizes, target.node_count);
    stream.run(kernels_.index, args, groups);
    stream.barrier();
    stream.run(kernels_.emit, args, groups);
    stream.barrier();
    move(stream, {.first_group = 0,
                  .triangle_count = target.triangle_count,
                  .node_count = target.node_count,
                  .pad = 0,
                  .triangles = args_.triangles,
                  .header = target.header,
                  .boxes = target.boxes,
                  .parents = target.parents,
                  .arrivals = 0});
}

void BvhBuilder::move(Stream& stream, const shared::BvhRefitArgs& args) const {
    stream.run(kernels_.move, args, groups_of(args.triangle_count));
}

void BvhBuilder::refit(Stream& stream, shared::BvhRefitArgs args) const {
    const Stream::Scope scope(stream, "refit");
    move(stream, args);
    stream.barrier();
    stream.run(kernels_.refit, args, group_count(args.node_count, climbing_group_size(gpu_)));
}

}  // namespace aglow::accel::gpu
