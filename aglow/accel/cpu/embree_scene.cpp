// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/cpu/embree_scene.h"

#include "aglow/shared/ray_hash.h"

#include <algorithm>
#include <bit>
#include <new>

namespace aglow::accel::cpu {
namespace {

constexpr unsigned kOpaque = 0;
constexpr unsigned kAlpha = 1;

/// The same ray gets the same answer from the same triangle, in every run.
float ray_hash(const RTCRayN* packet, unsigned count, unsigned i, uint32_t triangle) {
    auto* rays = const_cast<RTCRayN*>(packet);
    const auto bits = [](float v) { return std::bit_cast<uint32_t>(v); };
    return shared::ray_hash(
        triangle,
        {bits(RTCRayN_org_x(rays, count, i)), bits(RTCRayN_org_y(rays, count, i)),
         bits(RTCRayN_org_z(rays, count, i))},
        {bits(RTCRayN_dir_x(rays, count, i)), bits(RTCRayN_dir_y(rays, count, i)),
         bits(RTCRayN_dir_z(rays, count, i))});
}

/// Calls decide(i, triangle, alpha) for each hit that is up for decision; false refuses the hit.
template <class Decide>
void filter(const RTCFilterFunctionNArguments* args, Decide&& decide) {
    const auto& test = *static_cast<const AlphaTest*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const uint32_t triangle = (*test.triangle_of)[RTCHitN_primID(args->hit, args->N, i)];
        const SurfacePoint at{triangle,
                              {RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)}};
        if (!decide(i, triangle, opacity(*test.scene, *test.surfaces, at))) args->valid[i] = 0;
    }
}

void filter_hit(const RTCFilterFunctionNArguments* args) {
    filter(args, [&](unsigned i, uint32_t triangle, float alpha) {
        return alpha >= 1 || ray_hash(args->ray, args->N, i, triangle) < alpha;
    });
}

void filter_shadow(const RTCFilterFunctionNArguments* args) {
    auto& shadow = *reinterpret_cast<ShadowContext*>(args->context);
    filter(args, [&](unsigned i, uint32_t, float alpha) {
        float& passing = shadow.passing[RTCRayN_id(args->ray, args->N, i)];
        passing *= 1 - alpha;
        return !(passing > 0);
    });
}

/// Puts up to a packet of rays into Embree's arrays and says which lanes hold one.
void load(std::span<const Ray> rays, RTCRay8& packet, int (&valid)[kPacketSize]) {
    for (size_t i = 0; i < kPacketSize; ++i) {
        valid[i] = i < rays.size() ? -1 : 0;
        const Ray& ray = rays[std::min(i, rays.size() - 1)];
        packet.org_x[i] = ray.origin.x;
        packet.org_y[i] = ray.origin.y;
        packet.org_z[i] = ray.origin.z;
        packet.dir_x[i] = ray.direction.x;
        packet.dir_y[i] = ray.direction.y;
        packet.dir_z[i] = ray.direction.z;
        packet.tnear[i] = kNear;
        packet.tfar[i] = ray.far;
        packet.time[i] = 0;
        packet.mask[i] = 0xffffffffu;
        packet.id[i] = static_cast<unsigned>(i);
        packet.flags[i] = 0;
    }
}

bool has_alpha(const Scene& scene, const SurfacePart& part) {
    return part.material >= 0 &&
           scene.materials[static_cast<size_t>(part.material)].alpha_mode != AlphaMode::opaque;
}

}  // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::create(const Scene& scene,
                                                         const Surfaces& surfaces) try {
    std::unique_ptr<EmbreeScene> result(new EmbreeScene);
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle)
        result->triangle_of_[has_alpha(scene, surfaces.part(triangle)) ? kAlpha : kOpaque]
            .push_back(triangle);
    result->alpha_test_ = {&scene, &surfaces, &result->triangle_of_[kAlpha]};

    result->device_ = rtcNewDevice(nullptr);
    if (!result->device_) return fail(Errc::device_lost, "Embree could not start");
    result->scene_ = rtcNewScene(result->device_);
    rtcSetSceneFlags(result->scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(result->scene_, RTC_BUILD_QUALITY_MEDIUM);
    result->attach(surfaces, kOpaque);
    result->attach(surfaces, kAlpha);
    rtcCommitScene(result->scene_);
    if (const RTCError error = rtcGetDeviceError(result->device_); error != RTC_ERROR_NONE)
        return fail(error == RTC_ERROR_OUT_OF_MEMORY ? Errc::out_of_memory : Errc::device_lost,
                    "Embree could not build the scene of " +
                        std::to_string(surfaces.triangles.size()) + " triangles");
    return result;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to trace rays against " +
                                         std::to_string(surfaces.triangles.size()) + " triangles");
}

void EmbreeScene::attach(const Surfaces& surfaces, unsigned geometry_id) {
    const std::vector<uint32_t>& triangles = triangle_of_[geometry_id];
    if (triangles.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                RTC_FORMAT_FLOAT3, sizeof(vec3),
                                                                surfaces.positions.size()));
    auto* indices = static_cast<uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), triangles.size()));
    if (vertices && indices) {
        std::copy(surfaces.positions.begin(), surfaces.positions.end(), vertices);
        for (size_t i = 0; i < triangles.size(); ++i) indices[i] = surfaces.triangles[triangles[i]];
        if (geometry_id == kAlpha) {
            rtcSetGeometryUserData(geometry, &alpha_test_);
            rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_shadow);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_, geometry, geometry_id);
    }
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::intersect(std::span<const Ray> rays, SurfaceHit* hits) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (; !rays.empty(); rays = rays.subspan(std::min(kPacketSize, rays.size()))) {
        const auto packet_rays = rays.first(std::min(kPacketSize, rays.size()));
        alignas(32) int valid[kPacketSize];
        RTCRayHit8 packet;
        load(packet_rays, packet.ray, valid);
        std::fill_n(packet.hit.geomID, kPacketSize, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], kPacketSize, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect8(valid, scene_, &context, &packet);
        for (size_t i = 0; i < packet_rays.size(); ++i, ++hits) {
            const unsigned geometry = packet.hit.geomID[i];
            if (geometry == RTC_INVALID_GEOMETRY_ID) {
                hits->distance = kInfinity;
                continue;
            }
            const vec3 normal{packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]};
            *hits = {
                {triangle_of_[geometry][packet.hit.primID[i]], {packet.hit.u[i], packet.hit.v[i]}},
                packet.ray.tfar[i],
                dot(normal, packet_rays[i].direction) < 0};
        }
    }
}

void EmbreeScene::visibility(std::span<const Ray> rays, float* passing) const {
    ShadowContext context;
    rtcInitIntersectContext(&context.embree);
    for (; !rays.empty(); rays = rays.subspan(std::min(kPacketSize, rays.size()))) {
        const auto packet_rays = rays.first(std::min(kPacketSize, rays.size()));
        alignas(32) int valid[kPacketSize];
        RTCRay8 packet;
        load(packet_rays, packet, valid);
        std::fill_n(context.passing, kPacketSize, 1.0f);
        rtcOccluded8(valid, scene_, &context.embree, &packet);
        for (size_t i = 0; i < packet_rays.size(); ++i)
            *passing++ = packet.tfar[i] < 0 ? 0 : context.passing[i];
    }
}

EmbreeScene::~EmbreeScene() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

}  // namespace aglow::accel::cpu
