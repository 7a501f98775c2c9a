// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/bvh/bvh.h"
#include "aglow/accel/gpu/testing/bvh_rays.comp.h"
#include "aglow/accel/gpu/testing/grid_reference.h"
#include "aglow/core/random.h"
#include "aglow/core/testing/demand.h"
#include "aglow/shared/structure.h"
#include "aglow/shared/triangle.h"
#include "aglow/vk/testing/test_device.h"

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace aglow::accel::gpu {

using Triangles = std::vector<shared::Triangle>;
using Queries = std::vector<shared::RayQuery>;
using Hits = std::vector<shared::RayHit>;

inline Triangles soup(size_t count, float size, uint32_t seed = 1) {
    Pcg32 random(seed);
    Triangles triangles(count);
    for (shared::Triangle& t : triangles) {
        t.a = random_vector(random, -1, 1);
        t.b = t.a + random_vector(random, -size, size);
        t.c = t.a + random_vector(random, -size, size);
    }
    return triangles;
}

/// A closed sphere of radius 1 with 2 * rings * segments triangles, poles included, whose vertices
/// are displaced by up to `bumps`.
inline Triangles sphere(int rings, int segments, float bumps = 0) {
    auto vertex = [&](int ring, int segment) {
        const uint32_t id = ring == 0 || ring == rings
                                ? static_cast<uint32_t>(ring)
                                : static_cast<uint32_t>(ring * segments + segment % segments);
        const float radius = 1 + bumps * Pcg32(id).uniform();
        if (ring == 0) return vec3{0, radius, 0};
        if (ring == rings) return vec3{0, -radius, 0};
        const float theta = kPi * static_cast<float>(ring) / static_cast<float>(rings);
        const float phi =
            2 * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
        return vec3{std::sin(theta) * std::cos(phi), std::cos(theta),
                    std::sin(theta) * std::sin(phi)} *
               radius;
    };
    Triangles triangles;
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < segments; ++j) {
            triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return triangles;
}

/// The cube [-1, 1]^3, each side in 2 * n * n triangles.
inline Triangles cube(int n) {
    Triangles triangles;
    auto at = [&](int axis, float side, int i, int j) {
        const float u = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
        const float v = 2 * static_cast<float>(j) / static_cast<float>(n) - 1;
        return axis == 0 ? vec3{side, u, v} : axis == 1 ? vec3{v, side, u} : vec3{u, v, side};
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (float side : {-1.0f, 1.0f}) {
            for (int i = 0; i < n * n; ++i) {
                const int x = i / n, y = i % n;
                triangles.push_back(
                    {at(axis, side, x, y), at(axis, side, x + 1, y), at(axis, side, x + 1, y + 1)});
                triangles.push_back(
                    {at(axis, side, x, y), at(axis, side, x + 1, y + 1), at(axis, side, x, y + 1)});
            }
        }
    }
    return triangles;
}

/// All triangles scaled, then moved.
inline Triangles moved(Triangles triangles, float scale, vec3 by) {
    for (shared::Triangle& t : triangles)
        t = {t.a * scale + by, t.b * scale + by, t.c * scale + by};
    return triangles;
}

/// The nearest hit by trying every triangle.
inline shared::RayHit brute_force(std::span<const shared::Triangle> triangles,
                                  const shared::RayQuery& ray) {
    shared::RayHit hit{ray.far, shared::kNoTriangle, {0, 0}};
    const shared::ShearedRay sheared = shared::sheared_ray(ray.origin, ray.direction);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const auto found = shared::intersect_triangle(sheared, triangles[i], ray.near, hit.t);
        if (found.hit != 0) hit = {found.t, i, found.barycentrics};
    }
    return hit;
}

/// A tree on the test's device and rays through it.
class BvhFixture {
public:
    explicit BvhFixture(const vk::TestDevice& device, BvhQuality quality = BvhQuality::clustered)
        : stream(device.stream()),
          bvh(demand(Bvh::create(device.gpu(), quality))),
          nearest_(kernel(device.gpu(), {0, 1, 0})),
          any_(kernel(device.gpu(), {1, 1, 0})),
          every_triangle_(kernel(device.gpu(), {0, 0, 1})) {}

    TriangleSpan upload(const Triangles& triangles) {
        demand(stream.finish());
        input_ = demand(
            vk::make_buffer_of(stream, std::span<const shared::Triangle>(triangles), "triangles"));
        stream.barrier();
        return {input_.address(), static_cast<uint32_t>(triangles.size())};
    }
    void build(const Triangles& triangles) {
        const TriangleSpan span = upload(triangles);
        demand(bvh->build(stream, span));
        stream.barrier();
    }
    void refit(const Triangles& triangles) {
        const TriangleSpan span = upload(triangles);
        demand(bvh->refit(stream, span));
        stream.barrier();
    }
    Hits trace(const Queries& queries) { return trace(nearest_, queries); }
    Hits trace_any(const Queries& queries) { return trace(any_, queries); }
    /// What trying every triangle finds, by the same test on the same device.
    Hits try_every_triangle(const Queries& queries) { return trace(every_triangle_, queries); }
    /// Work of the rays traced last.
    shared::TraceCounts counts() const { return counts_; }

    std::vector<shared::BvhNode> nodes() {
        return demand(stream.download<shared::BvhNode>(bvh->nodes(), bvh->stats().cells));
    }
    std::vector<shared::BvhTriangle> triangles() {
        return demand(
            stream.download<shared::BvhTriangle>(bvh->triangles(), bvh->stats().references));
    }

    vk::Stream stream;
    std::unique_ptr<Bvh> bvh;

private:
    static vk::Kernel kernel(const Gpu& gpu, std::array<uint32_t, 3> constants) {
        return demand(vk::Kernel::create(gpu, "rays", shaders::bvh_rays_comp, constants));
    }
    Hits trace(const vk::Kernel& rays_kernel, const Queries& queries) {
        struct Args {
            uint32_t first_group, ray_count;
            uint64_t header, rays, hits, counts;
        };
        const vk::Buffer rays =
            demand(vk::make_buffer_of(stream, std::span<const shared::RayQuery>(queries), "rays"));
        const vk::Buffer hits =
            demand(stream.make_buffer(queries.size() * sizeof(shared::RayHit), "hits"));
        const vk::Buffer counts = demand(stream.make_buffer(sizeof(shared::TraceCounts), "counts"));
        stream.fill(counts, 0, 0, sizeof(shared::TraceCounts));
        stream.barrier();
        stream.run(rays_kernel,
                   Args{0, static_cast<uint32_t>(queries.size()), bvh->header(), rays.address(),
                        hits.address(), counts.address()},
                   vk::group_count(queries.size(), 64));
        counts_ = demand(stream.download<shared::TraceCounts>(counts, 1))[0];
        return demand(stream.download<shared::RayHit>(hits, queries.size()));
    }

    vk::Buffer input_;
    vk::Kernel nearest_, any_, every_triangle_;
    shared::TraceCounts counts_ = {};
};

}  // namespace aglow::accel::gpu
