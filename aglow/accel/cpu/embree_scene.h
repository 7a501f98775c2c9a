// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"

#include <embree3/rtcore.h>

#include <memory>
#include <span>
#include <vector>

namespace aglow::accel::cpu {

/// Where rays begin. Embree takes hits at tnear itself, but what a ray starts on does not count as
/// met: this is above zero and below any distance between things.
inline constexpr float kNear = 1e-30f;

/// What filter functions read to decide whether a ray passes a masked or blended surface.
struct AlphaTest {
    const Scene* scene;
    const Surfaces* surfaces;
    const std::vector<uint32_t>* triangle_of;
};

/// Where a ray meets a triangle.
struct SurfaceHit {
    SurfacePoint at;
    float distance;
    bool front;
};

/// Rays that are traced together walk much the same nodes if they leave one place.
inline constexpr size_t kPacketSize = 8;

/// Shadow rays on their way; the first member is what Embree sees of them.
struct ShadowContext {
    RTCIntersectContext embree;
    float passing[kPacketSize];  ///< [ray id] share of light that the surfaces met so far let pass
};

/// An Embree scene of two geometries: triangles that always block, and triangles whose alpha
/// decides. Watertight (RTC_SCENE_FLAG_ROBUST).
class EmbreeScene {
public:
    static Result<std::unique_ptr<EmbreeScene>> create(const Scene& scene,
                                                       const Surfaces& surfaces);
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene();

    /// Nearest hit within (0, far); false where there is none.
    bool intersect(vec3 origin, vec3 direction, float far, SurfaceHit& hit) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query;
        query.ray = make_ray(origin, direction, far);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        hit.at = {triangle_of_[query.hit.geomID][query.hit.primID], {query.hit.u, query.hit.v}};
        hit.distance = query.ray.tfar;
        const vec3 normal{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
        hit.front = dot(normal, direction) < 0;
        return true;
    }

    float visibility(vec3 origin, vec3 direction, float far) const {
        ShadowContext context;
        rtcInitIntersectContext(&context.embree);
        context.passing[0] = 1;
        RTCRay ray = make_ray(origin, direction, far);
        rtcOccluded1(scene_, &context.embree, &ray);
        return ray.tfar < 0 ? 0 : context.passing[0];
    }

    /// The same for many rays, traced in packets: faster than one by one where they leave one
    /// place. hits[i].distance is kInfinity where ray i meets nothing.
    void intersect(std::span<const Ray> rays, SurfaceHit* hits) const;
    void visibility(std::span<const Ray> rays, float* passing) const;

private:
    EmbreeScene() = default;
    void attach(const Surfaces& surfaces, unsigned geometry_id);

    static RTCRay make_ray(vec3 origin, vec3 direction, float far) {
        RTCRay ray;
        ray.org_x = origin.x;
        ray.org_y = origin.y;
        ray.org_z = origin.z;
        ray.tnear = kNear;
        ray.dir_x = direction.x;
        ray.dir_y = direction.y;
        ray.dir_z = direction.z;
        ray.time = 0;
        ray.tfar = far;
        ray.mask = 0xffffffffu;
        ray.id = 0;
        ray.flags = 0;
        return ray;
    }

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::vector<uint32_t> triangle_of_[2];  // [geometry][primitive]: 0 opaque, 1 with alpha
    AlphaTest alpha_test_{};
};

}  // namespace aglow::accel::cpu
