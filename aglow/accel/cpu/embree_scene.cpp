// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/cpu/embree_scene.h"

#include "aglow/shared/sobol.h"

#include <bit>
#include <new>

namespace aglow::accel::cpu {
namespace {

constexpr unsigned kOpaque = 0;
constexpr unsigned kAlpha = 1;

/// The same ray gets the same answer from the same triangle, in every run.
float ray_hash(const RTCRayN* rays, unsigned count, unsigned i, uint32_t triangle) {
    uint32_t hash = shared::hash_bits(triangle);
    for (const float component : {RTCRayN_org_x(const_cast<RTCRayN*>(rays), count, i),
                                  RTCRayN_org_y(const_cast<RTCRayN*>(rays), count, i),
                                  RTCRayN_org_z(const_cast<RTCRayN*>(rays), count, i),
                                  RTCRayN_dir_x(const_cast<RTCRayN*>(rays), count, i),
                                  RTCRayN_dir_y(const_cast<RTCRayN*>(rays), count, i),
                                  RTCRayN_dir_z(const_cast<RTCRayN*>(rays), count, i)})
        hash = shared::hash_pair(hash, std::bit_cast<uint32_t>(component));
    return shared::unit_float(hash);
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

/// Shadow rays are traced one by one, so the context belongs to the ray.
void filter_shadow(const RTCFilterFunctionNArguments* args) {
    auto& shadow = *reinterpret_cast<ShadowContext*>(args->context);
    filter(args, [&](unsigned, uint32_t, float alpha) {
        shadow.passing *= 1 - alpha;
        return !(shadow.passing > 0);
    });
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

EmbreeScene::~EmbreeScene() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

}  // namespace aglow::accel::cpu
