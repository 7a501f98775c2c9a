// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/accel/gpu/testing/grid_rays.comp.h"
#include "aglow/accel/gpu/testing/grid_read.comp.h"
#include "aglow/accel/gpu/testing/grid_reference.h"
#include "aglow/core/testing/demand.h"
#include "aglow/shared/structure.h"
#include "aglow/vk/device.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace aglow::accel::gpu {

using shared::RayHit;
using shared::RayQuery;
using shared::Triangle;

/// What a grid answered, and what it cost.
struct Traced {
    std::vector<RayHit> hits;
    std::vector<uvec2> counts;    ///< cells and triangle tests of each ray
    double steps = 0, tests = 0;  ///< per ray
};

/// One structure of a kind on a device, and a kernel that traces rays through it alone.
class GridHarness {
public:
    GridHarness(const Gpu& gpu, uint32_t kind)
        : gpu_(gpu),
          stream_(demand(vk::Stream::create(gpu))),
          structure_(demand(kind == shared::kStructureGrid ? make_grid(gpu) : make_grid2(gpu))),
          nearest_(kernel(kind, 0)),
          any_(kernel(kind, 1)),
          read_(demand(vk::Kernel::create(gpu, "grid read", shaders::grid_read_comp))) {}

    Structure& structure() { return *structure_; }
    vk::Stream& stream() { return stream_; }

    /// A stream that has failed stays so.
    void renew_stream() { stream_ = demand(vk::Stream::create(gpu_)); }

    Status build(std::span<const Triangle> triangles) {
        AG_TRY(triangles_, vk::make_buffer_of(stream_, triangles, "triangles"));
        stream_.barrier();
        AG_CHECK(structure_->build(
            stream_, {triangles_.address(), static_cast<uint32_t>(triangles.size())}));
        return stream_.finish();
    }

    Traced trace(std::span<const RayQuery> rays, bool any = false) {
        const uint64_t count = rays.size();
        vk::Buffer queries = demand(vk::make_buffer_of(stream_, rays, "rays"));
        vk::Buffer hits = demand(gpu_->make_buffer(count * sizeof(RayHit), "hits"));
        vk::Buffer counts = demand(gpu_->make_buffer(count * sizeof(uvec2), "counts"));
        stream_.barrier();
        struct {
            uint32_t first_group;
            uint32_t count;
            uint64_t header, rays, hits, counts;
        } args = {0,
                  static_cast<uint32_t>(count),
                  structure_->header(),
                  queries.address(),
                  hits.address(),
                  counts.address()};
        stream_.run(any ? any_ : nearest_, args, vk::group_count(count, 64));
        Traced traced;
        traced.hits = demand(stream_.download<RayHit>(hits, count));
        traced.counts = demand(stream_.download<uvec2>(counts, count));
        for (const uvec2& c : traced.counts) {
            traced.steps += c.x / static_cast<double>(count);
            traced.tests += c.y / static_cast<double>(count);
        }
        return traced;
    }

    /// What lies at an address on the device.
    template <class T>
    std::vector<T> read(uint64_t address, uint64_t count) {
        static_assert(sizeof(T) % 4 == 0);
        vk::Buffer copy = demand(gpu_->make_buffer(count * sizeof(T), "copy"));
        struct {
            uint32_t first_group;
            uint32_t count;
            uint64_t from, to;
        } args = {0, static_cast<uint32_t>(count * sizeof(T) / 4), address, copy.address()};
        stream_.barrier();
        stream_.run(read_, args, vk::group_count(args.count, 64));
        return demand(stream_.download<T>(copy, count));
    }

private:
    vk::Kernel kernel(uint32_t kind, uint32_t any) const {
        const std::array<uint32_t, 2> constants = {kind == shared::kStructureGrid2 ? 1u : 0u, any};
        return demand(vk::Kernel::create(gpu_, "grid rays", shaders::grid_rays_comp, constants));
    }

    Gpu gpu_;
    vk::Stream stream_;
    std::unique_ptr<Structure> structure_;
    vk::Kernel nearest_, any_, read_;
    vk::Buffer triangles_;
};

/// The nearest hit of a ray among all triangles, one by one.
inline RayHit nearest_hit(std::span<const Triangle> triangles, const RayQuery& ray) {
    RayHit best = {ray.far, shared::kNoTriangle, {}};
    const auto sheared = shared::sheared_ray(ray.origin, ray.direction);
    for (size_t i = 0; i < triangles.size(); ++i) {
        if (!shared::is_usable_triangle(triangles[i])) continue;
        const auto found = shared::intersect_triangle(sheared, triangles[i], ray.near, best.t);
        if (found.hit != 0) best = {found.t, static_cast<uint32_t>(i), found.barycentrics};
    }
    return best;
}

}  // namespace aglow::accel::gpu
