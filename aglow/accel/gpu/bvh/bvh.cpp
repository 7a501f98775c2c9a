// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/bvh/bvh.h"

#include "aglow/accel/gpu/bvh/bvh_builder.h"
#include "aglow/core/assert.h"
#include "aglow/shared/structure.h"
#include "aglow/vk/device.h"

#include <fmt/format.h>

#include <span>
#include <utility>

namespace aglow::accel::gpu {

using shared::BvhCounters;
using vk::Stream;

namespace {

/// Parts of Bvh::links_ for `capacity` nodes.
uint64_t boxes_of(const vk::Buffer& links) { return links.address(); }
constexpr uint64_t kLinkBytes = sizeof(shared::Bounds) + 4 + 4;
uint64_t capacity_of(const vk::Buffer& links) { return links.size() / kLinkBytes; }
uint64_t parents_offset(const vk::Buffer& links) {
    return capacity_of(links) * sizeof(shared::Bounds);
}
uint64_t arrivals_offset(const vk::Buffer& links) {
    return parents_offset(links) + 4 * capacity_of(links);
}

}  // namespace

Result<std::unique_ptr<Bvh>> Bvh::create(const Gpu& gpu, BvhQuality quality) {
    AG_TRY(auto builder, BvhBuilder::create(gpu));
    return std::make_unique<Bvh>(std::move(builder), quality);
}

Bvh::Bvh(std::shared_ptr<BvhBuilder> builder, BvhQuality quality)
    : builder_(std::move(builder)), quality_(quality) {}

Bvh::~Bvh() = default;

uint32_t Bvh::kind() const { return shared::kStructureBvh; }

std::unique_ptr<Structure> Bvh::sibling() const {
    return std::make_unique<Bvh>(builder_, quality_);
}

StructureStats Bvh::stats() const {
    return {.bytes = node_count_ * (sizeof(shared::BvhNode) + kLinkBytes) +
                     triangle_count_ * sizeof(shared::BvhTriangle),
            .references = triangle_count_,
            .cells = node_count_};
}

void Bvh::clear() { built_over_ = node_count_ = triangle_count_ = depth_ = 0; }

Status Bvh::upload_header(Stream& stream) {
    const shared::BvhHeader header{.nodes = nodes_.address(),
                                   .triangles = triangles_.address(),
                                   .box = shared::empty_bounds(),
                                   .node_count = node_count_,
                                   .triangle_count = triangle_count_};
    stream.upload(std::span(&header, 1), header_);
    return {};
}

Status Bvh::build(Stream& stream, TriangleSpan triangles) {
    AG_ASSERT(triangles.count < shared::kLeafSlot / 2, "fewer than 2^30 triangles");
    clear();
    if (header_.size() == 0) {
        AG_TRY(header_, stream.make_buffer(sizeof(shared::BvhHeader), "header of a BVH"));
    }
    if (triangles.count == 0) return upload_header(stream);
    auto built = build_tree(stream, triangles);
    if (!built) {
        clear();
        AG_CHECK(upload_header(stream));
    }
    return built;
}

Status Bvh::build_tree(Stream& stream, TriangleSpan triangles) {
    BvhBuilder& builder = *builder_;
    AG_CHECK(builder.reserve(stream, triangles));
    builder.sort(stream);
    const bool clusters = quality_ == BvhQuality::clustered;
    builder.cluster(stream, clusters ? shared::kMergeKeep : 1);
    const bool shallow = quality_ == BvhQuality::shallow;
    AG_TRY(BvhCounters counters,
           builder.collapse(stream, shallow ? shared::kCostDepth : shared::kCostTime));
    if (counters.depth > shared::kBvhMaxDepth) {
        AG_TRY(counters, builder.collapse(stream, shared::kCostDepth));
    }
    if (counters.depth > shared::kBvhMaxDepth) {
        // At most 30 levels for the bits of the codes and 32 for the order of equal ones: three
        // to a wide level, 21 in all.
        builder.cluster(stream, 1);
        AG_TRY(counters, builder.collapse(stream, shared::kCostDepth));
    }

    AG_CHECK(reserve_tree(counters));
    built_over_ = triangles.count;
    node_count_ = counters.node_count;
    triangle_count_ = counters.usable_count;
    depth_ = counters.depth;
    AG_CHECK(upload_header(stream));
    stream.barrier();
    if (node_count_ == 0) return {};
    builder.emit(stream, {.header = header_.address(),
                          .boxes = boxes_of(links_),
                          .parents = links_.address() + parents_offset(links_),
                          .node_count = node_count_,
                          .triangle_count = triangle_count_});
    return {};
}

Status Bvh::reserve_tree(const BvhCounters& counters) {
    const uint64_t nodes = counters.node_count * sizeof(shared::BvhNode);
    const uint64_t triangles = counters.usable_count * sizeof(shared::BvhTriangle);
    const uint64_t links = counters.node_count * kLinkBytes;
    auto reserve = [&]() -> Status {
        const Gpu& gpu = builder_->gpu();
        AG_CHECK(gpu->grow(nodes_, nodes, "nodes of a BVH"));
        AG_CHECK(gpu->grow(triangles_, triangles, "triangles of a BVH"));
        AG_CHECK(gpu->grow(links_, links, "links of a BVH"));
        return {};
    };
    auto reserved = reserve();
    if (!reserved && reserved.error().code == Errc::out_of_memory) {
        return fail(Errc::out_of_memory,
                    fmt::format("a BVH over {} triangles takes {} bytes: {}", counters.usable_count,
                                nodes + triangles + links, reserved.error().message));
    }
    return reserved;
}

Status Bvh::refit(Stream& stream, TriangleSpan triangles) {
    const bool knows_all = built_over_ == triangles.count && triangle_count_ == triangles.count;
    if (!knows_all) return build(stream, triangles);
    if (triangles.count == 0) return {};
    stream.fill(links_, 0, arrivals_offset(links_), 4ull * node_count_);
    stream.barrier();
    builder_->refit(stream, {.first_group = 0,
                             .triangle_count = triangle_count_,
                             .node_count = node_count_,
                             .pad = 0,
                             .triangles = triangles.address,
                             .header = header_.address(),
                             .boxes = boxes_of(links_),
                             .parents = links_.address() + parents_offset(links_),
                             .arrivals = links_.address() + arrivals_offset(links_)});
    return {};
}

Result<std::unique_ptr<Structure>> make_bvh(const Gpu& gpu) {
    AG_TRY(auto bvh, Bvh::create(gpu));
    return std::unique_ptr<Structure>(std::move(bvh));
}

}  // namespace aglow::accel::gpu
