// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/result.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <memory>

namespace aglow::accel::gpu {

/// Triangles on the device: `count` of shared::Triangle at `address`.
struct TriangleSpan {
    uint64_t address = 0;
    uint32_t count = 0;
};

/// What a structure is made of, for tables and for judging it.
struct StructureStats {
    uint64_t bytes = 0;       ///< of the finished structure, its triangles included
    uint64_t references = 0;  ///< triangles in cells or leaves, repeated ones counted
    uint64_t cells = 0;       ///< cells or nodes
};

/// One acceleration structure, built on the device.
class Structure {
public:
    virtual ~Structure() = default;
    virtual uint32_t kind() const = 0;  ///< shared::kStructure...

    /// Builds from nothing over a copy of the triangles. Triangles that are not finite, and
    /// degenerate ones, are hit by nothing. Memory grows as needed and is kept for the next build.
    /// May finish() the stream to read counts; ends without barrier.
    /// Errors  out_of_memory (says the bytes needed), device_lost. After an error the structure is
    ///         empty, and may be built again.
    virtual Status build(vk::Stream& stream, TriangleSpan triangles) = 0;

    /// Follows triangles that moved, as many as in the last build; a structure that cannot refit
    /// builds anew. The answer of rays is right after any motion; their cost grows with it.
    virtual Status refit(vk::Stream& stream, TriangleSpan triangles) {
        return build(stream, triangles);
    }

    /// An empty structure of the same kind. It shares this one's kernels and scratch memory (both
    /// held by shared_ptr), so that a scene may hold thousands: a barrier has to stand between the
    /// builds of structures that share.
    virtual std::unique_ptr<Structure> sibling() const = 0;

    virtual uint64_t header() const = 0;  ///< address for shared::Instance
    virtual StructureStats stats() const = 0;
};

Result<std::unique_ptr<Structure>> make_grid(const Gpu& gpu);
Result<std::unique_ptr<Structure>> make_grid2(const Gpu& gpu);
Result<std::unique_ptr<Structure>> make_bvh(const Gpu& gpu);

}  // namespace aglow::accel::gpu
