// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/shared/bvh_emit.h"
#include "aglow/vk/buffer.h"

#include <memory>

namespace aglow::accel::gpu {

class BvhBuilder;

/// How good a tree is made of the triangles.
enum class BvhQuality : uint8_t {
    clustered,  ///< H-PLOC: for rays
    morton,     ///< the hierarchy of the Morton codes: to compare with
    shallow     ///< that hierarchy, made as shallow as can be: what deep trees fall back on
};

/// A tree of boxes, eight wide, with quantised boxes: see shared/bvh.h.
/// Repeat  the same tree every run.
/// Cost    O(n log n); about 160 bytes per triangle while it is built, shared by siblings, and 60
///         to keep.
/// Source  see shared/bvh_build.h, shared/bvh_collapse.h and shared/bvh.h.
class Bvh final : public Structure {
public:
    static Result<std::unique_ptr<Bvh>> create(const Gpu& gpu,
                                               BvhQuality quality = BvhQuality::clustered);
    Bvh(std::shared_ptr<BvhBuilder> builder, BvhQuality quality);
    ~Bvh() override;

    uint32_t kind() const override;
    Status build(vk::Stream& stream, TriangleSpan triangles) override;
    /// Moves the boxes with the triangles. Builds anew where the last build met triangles that
    /// were not finite, which are not in the tree.
    Status refit(vk::Stream& stream, TriangleSpan triangles) override;
    std::unique_ptr<Structure> sibling() const override;
    uint64_t header() const override { return header_.address(); }
    StructureStats stats() const override;

    uint32_t depth() const { return depth_; }  ///< nodes on the longest way from the root at most
    /// The tree, for whoever looks at it: shared::BvhNode[stats().cells], shared::BvhTriangle
    /// [stats().references].
    const vk::Buffer& nodes() const { return nodes_; }
    const vk::Buffer& triangles() const { return triangles_; }

private:
    Status build_tree(vk::Stream& stream, TriangleSpan triangles);
    Status reserve_tree(const shared::BvhCounters& counters);
    Status upload_header(vk::Stream& stream);
    void clear();

    std::shared_ptr<BvhBuilder> builder_;
    BvhQuality quality_;
    vk::Buffer header_;
    vk::Buffer nodes_;      // shared::BvhNode[]
    vk::Buffer triangles_;  // shared::BvhTriangle[]
    vk::Buffer links_;      // for refitting: shared::Bounds[], parents and arrivals of the nodes
    uint32_t built_over_ = 0;
    uint32_t node_count_ = 0;
    uint32_t triangle_count_ = 0;
    uint32_t depth_ = 0;
};

}  // namespace aglow::accel::gpu
