// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/surface_distance.h"

#include "aglow/core/parallel.h"
#include "aglow/core/random.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <type_traits>

namespace aglow {
namespace {

template <auto Release>
struct Releaser {
    template <class T>
    void operator()(T* object) const {
        Release(object);
    }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<rtcReleaseGeometry>>;

/// The point of the triangle a, b, c next to p, by the region of its plane that p lies over.
/// Source  Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
vec3 closest_point(vec3 p, vec3 a, vec3 b, vec3 c) {
    const vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const vec3 bp = p - b;
    const float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? a + ab * (d1 / (d1 - d3)) : a;
    const vec3 cp = p - c;
    const float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 > d6 ? a + ac * (d2 / (d2 - d6)) : a;
    const float va = d3 * d6 - d5 * d4;
    const float e = d4 - d3, f = d5 - d6;
    if (va <= 0 && e >= 0 && f >= 0) return e + f > 0 ? b + (c - b) * (e / (e + f)) : b;
    const float sum = va + vb + vc;
    return sum > 0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

/// Called for triangles within the query's radius, which it draws in.
bool visit(RTCPointQueryFunctionArguments* arguments) {
    const auto& surface = *static_cast<const TriangleSurface*>(arguments->userPtr);
    RTCPointQuery& query = *arguments->query;
    const vec3 p{query.x, query.y, query.z};
    const uvec3 t = surface.triangles[arguments->primID];
    const vec3 nearest =
        closest_point(p, surface.positions[t.x], surface.positions[t.y], surface.positions[t.z]);
    const float distance = length(p - nearest);
    if (!(distance < query.radius)) return false;
    query.radius = distance;
    return true;
}

Result<EmbreeScene> make_scene(RTCDevice device, const TriangleSurface& surface) {
    const auto refuse = [] {
        return fail(Errc::out_of_memory, "the tree of a surface does not fit into memory");
    };
    EmbreeScene scene(rtcNewScene(device));
    const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    if (!scene || !geometry) return refuse();
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(vec3), surface.positions.size()));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(uvec3), surface.triangles.size()));
    if (!vertices || !indices) return refuse();
    for (const vec3 p : surface.positions)
        for (const float x : {p.x, p.y, p.z}) *vertices++ = x;
    for (const uvec3 t : surface.triangles)
        for (const uint32_t v : {t.x, t.y, t.z}) *indices++ = v;
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    rtcCommitScene(scene.get());
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return refuse();
    return scene;
}

/// Points of equal shares of the area, one at random in each.
std::vector<vec3> area_samples(const TriangleSurface& surface, size_t count) {
    std::vector<double> until;  // area up to the end of each triangle
    double area = 0;
    for (const uvec3 t : surface.triangles) {
        const vec3 a = surface.positions[t.x];
        area += length(cross(surface.positions[t.y] - a, surface.positions[t.z] - a));
        until.push_back(area);
    }
    std::vector<vec3> points;
    if (!(area > 0)) return points;
    Pcg32 random(count);
    size_t at = 0;
    for (size_t i = 0; i < count; ++i) {
        const double share = area / static_cast<double>(count);
        const double where = share * (static_cast<double>(i) + random.uniform());
        while (at + 1 < until.size() && until[at] <= where) ++at;
        const uvec3 t = surface.triangles[at];
        const float root = std::sqrt(random.uniform()), v = random.uniform();
        points.push_back(surface.positions[t.x] * (1 - root) +
                         surface.positions[t.y] * (root * (1 - v)) +
                         surface.positions[t.z] * (root * v));
    }
    return points;
}

/// From one surface to the other.
Status measure(const TriangleSurface& from, const TriangleSurface& to, size_t samples,
               SurfaceDifference& difference) {
    std::vector<vec3> points = area_samples(from, samples);
    const size_t by_area = points.size();
    std::vector<bool> used(from.positions.size(), false);
    for (const uvec3 t : from.triangles)
        for (const uint32_t v : {t.x, t.y, t.z}) {
            if (!used[v]) points.push_back(from.positions[v]);
            used[v] = true;
        }
    AG_TRY(const std::vector<float> far, distances(points, to));
    double sum = 0;
    for (size_t i = 0; i < far.size(); ++i) {
        const double d = far[i];
        if (i < by_area) sum += d * d;
        difference.hausdorff = std::max(difference.hausdorff, d);
    }
    if (by_area > 0)
        difference.rms = std::max(difference.rms, std::sqrt(sum / static_cast<double>(by_area)));
    difference.samples += points.size();
    return {};
}

}  // namespace

Result<std::vector<float>> distances(std::span<const vec3> points, const TriangleSurface& surface) {
    std::vector<float> result(points.size(), kInfinity);
    if (surface.triangles.empty()) return result;
    const Device device(rtcNewDevice(nullptr));
    if (!device) return fail(Errc::out_of_memory, "Embree has no memory for a device");
    AG_TRY(const EmbreeScene scene, make_scene(device.get(), surface));
    constexpr size_t kGrain = 1024;
    parallel_for(points.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            RTCPointQuery query{points[i].x, points[i].y, points[i].z, 0, kInfinity};
            RTCPointQueryContext context;
            rtcInitPointQueryContext(&context);
            rtcPointQuery(scene.get(), &query, &context, visit,
                          const_cast<TriangleSurface*>(&surface));
            result[i] = query.radius;
        }
    });
    return result;
}

Result<SurfaceDifference> surface_difference(const TriangleSurface& a, const TriangleSurface& b,
                                             size_t samples) {
    try {
        SurfaceDifference difference;
        AG_CHECK(measure(a, b, samples, difference));
        AG_CHECK(measure(b, a, samples, difference));
        return difference;
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the points to measure at do not fit into memory");
    }
}

}  // namespace aglow
